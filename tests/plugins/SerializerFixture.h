#pragma once

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

/// Keeps the texts of all errors.
class CollectErrors : public osgVolumizer::ErrorHandler
{
public:
    void operator()(const osgVolumizer::Status& status) override { text += status.text + "\n"; }
    std::string text;
};

/// Writes and reads scenes in the format that is the test's parameter, in a folder of its own.
class SerializerTest : public testing::TestWithParam<const char*>
{
protected:
    SerializerTest() : _errors(new CollectErrors)
    {
        std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        for (char& c : name)
            if (c == '/') c = '.';
        _folder = std::filesystem::path(testing::TempDir()) / ("Serializer." + name);
        std::filesystem::create_directories(_folder);
        osgVolumizer::setErrorHandler(_errors.get());
    }
    ~SerializerTest() override { osgVolumizer::setErrorHandler(nullptr); }

    std::string scene() const { return path(std::string("scene.") + GetParam()); }
    std::string path(const std::string& file) const { return (_folder / file).string(); }
    const std::string& errors() const { return _errors->text; }
    void clearErrors() { _errors->text.clear(); }

    void writeFile(const std::string& file, const std::string& content) const
    {
        std::ofstream(path(file), std::ios::binary) << content;
    }
    /// The content of the file that an object is written to.
    std::string write(const osg::Object& object) const
    {
        EXPECT_TRUE(osgDB::writeObjectFile(object, scene()));
        std::ostringstream content;
        content << std::ifstream(scene(), std::ios::binary).rdbuf();
        return content.str();
    }
    osg::ref_ptr<osg::Object> read(const std::string& content) const
    {
        writeFile(std::string("scene.") + GetParam(), content);
        return osgDB::readRefObjectFile(scene());
    }
    template <class T>
    osg::ref_ptr<T> roundTrip(const T& object) const
    {
        write(object);
        osg::ref_ptr<osg::Object> copy = osgDB::readRefObjectFile(scene());
        return dynamic_cast<T*>(copy.get());
    }

private:
    std::filesystem::path _folder;
    osg::ref_ptr<CollectErrors> _errors;
};
