// A program that is linked with the library and calls nothing of it: volumes come with scene files.
#include <osgDB/ReadFile>

#include <cstdio>
#include <string>

int main()
{
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile("consumer.osgt");
    if (scene && scene->libraryName() == std::string("osgVolumizer")) return 0;
    std::fprintf(stderr, "The volume was not read\n");
    return 1;
}
