// A scene with a volume, written and read back through the installed plugins, which lie beside the
// library: nothing here says where.
#include <osgVolumizer/Version.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cstdio>
#include <string>

namespace {

int fail(const std::string& text)
{
    std::fprintf(stderr, "%s\n", text.c_str());
    return 1;
}

} // namespace

int main()
{
    if (std::string(osgVolumizer::getVersion()) != OSGVOLUMIZER_VERSION)
        return fail("The header and the library differ in version");

    osg::ref_ptr<osgVolumizer::MemoryVoxelSource> source = new osgVolumizer::MemoryVoxelSource;
    osgVolumizer::VoxelSource::Description description;
    description.size = glm::ivec3(4, 5, 6);
    osgVolumizer::Status status = source->allocate(description);
    if (!status.ok()) return fail(status.text);

    osg::ref_ptr<osgVolumizer::VolumeAppearance> volume = new osgVolumizer::VolumeAppearance;
    volume->setVoxels(new osgVolumizer::Voxels(source.get()));
    volume->addChild(osgVolumizer::VolumeGeometry::createBox(*volume->getVoxels()));
    if (volume->getChild(0)->getBound().center() != osg::Vec3(1.5f, 2.0f, 2.5f))
        return fail("The box does not span the voxels");

    if (!osgDB::writeNodeFile(*volume, "consumer.osgt")) return fail("The scene was not written");
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile("consumer.osgt");
    auto* back = dynamic_cast<osgVolumizer::VolumeAppearance*>(scene.get());
    if (!back) return fail("The scene was not read back");
    if (!back->getVoxels() || back->getVoxels()->getLayout().size() != description.size)
        return fail("The voxels were not read back");
    return 0;
}
