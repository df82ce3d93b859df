// The .volume pseudo-loader through osgDB, as osgviewer uses it.
#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include "../support/FolderTest.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <osg/Transform>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace VolumeLoaderTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

class VolumeLoader : public support::FolderTest
{
protected:
    void SetUp() override
    {
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(OSGVOLUMIZER_BINARY_DIR
                                                                         "/lib");
        FolderTest::SetUp();
        clearLastError();
    }
    void writeSlice(const std::string& name) const
    {
        auto out = OIIO::ImageOutput::create(path(name));
        const OIIO::ImageSpec spec(4, 3, 1, OIIO::TypeDesc::UINT8);
        const std::vector<std::uint8_t> pixels(12, 9);
        ASSERT_TRUE(out && out->open(path(name), spec));
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    }

    static osgDB::ReaderWriter::ReadResult read(const std::string& name,
                                                const std::string& options = {})
    {
        osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        o->setObjectCacheHint(osgDB::Options::CACHE_NONE);
        return osgDB::Registry::instance()->readNode(name, o.get());
    }
    static osg::ref_ptr<VolumeAppearance> load(const std::string& name,
                                               const std::string& options = {})
    {
        auto result = read(name, options);
        EXPECT_TRUE(result.validNode()) << name << ": " << result.statusMessage();
        return dynamic_cast<VolumeAppearance*>(result.getNode());
    }

    static const VolumeGeometry& geometryOf(osg::Node& node)
    {
        osg::Node* n = &node;
        while (n->asGroup() && n->asGroup()->getNumChildren() == 1)
            n = n->asGroup()->getChild(0);
        return dynamic_cast<VolumeGeometry&>(*n);
    }
};

} // namespace

TEST_F(VolumeLoader, AnImageFile)
{
    const auto head =
        load(OSGVOLUMIZER_SOURCE_DIR "/data/head.tif.volume",
             "spacing=1,1,1.5 origin=-64,-64,-63 table=head.lut unit=1.2 range=0,200");
    ASSERT_TRUE(head.valid());
    EXPECT_EQ(osg::Vec3i(128, 128, 84), head->getVoxels()->getSize());
    EXPECT_EQ(osg::Vec2d(0, 200), head->getVoxels()->getRange());
    EXPECT_EQ(1.2, head->getOpacityUnit());
    EXPECT_EQ("head.tif", head->getName());
    // The table lies beside the volume.
    EXPECT_EQ(LookupTable::DATA_VALUES, head->getLookupTable()->getDomain());
    EXPECT_EQ(13u, head->getLookupTable()->getFunction()->points().size());
    const osg::BoundingBox box = geometryOf(*head).getBoundingBox();
    EXPECT_EQ(osg::Vec3(-64, -64, -63), osg::Vec3(box._min));
    EXPECT_EQ(osg::Vec3(63, 63, 61.5), osg::Vec3(box._max));
}

TEST_F(VolumeLoader, AFolderAndAPattern)
{
    fs::create_directories(path("stack"));
    for (const char* name : {"stack/s008.png", "stack/s009.png", "stack/s010.png"})
        writeSlice(name);
    for (const char* name : {"stack", "stack/", "stack/s%03d.png", "stack/s###.png"}) {
        const auto volume = load(path(name) + ".volume");
        ASSERT_TRUE(volume.valid()) << name;
        EXPECT_EQ(osg::Vec3i(4, 3, 3), volume->getVoxels()->getSize());
    }
}

TEST_F(VolumeLoader, ARawFile)
{
    const std::string file = writeBytes("engine.raw", "HEAD" + std::string(2 * 5 * 4 * 3, 'x'));
    const auto volume = load(file + ".5,4,3,int16,4,big.volume");
    ASSERT_TRUE(volume.valid());
    EXPECT_EQ(osg::Vec3i(5, 4, 3), volume->getVoxels()->getSize());
    EXPECT_EQ(VoxelType::INT16, volume->getVoxels()->getType());
    // Every type.
    for (int t = 0; t <= static_cast<int>(VoxelType::FLOAT64); ++t) {
        const auto type = static_cast<VoxelType>(t);
        writeBytes("any.raw", std::string(27 * voxelTypeSize(type), '\0'));
        EXPECT_TRUE(load(path("any.raw.3,3,3,") + voxelTypeName(type) + ".volume").valid());
    }
}

TEST_F(VolumeLoader, ErrorsCarryTheirMessage)
{
    const std::string file = writeBytes("v.raw", std::string(60, 'x'));
    const std::pair<std::string, std::string> cases[] = {
        {path("none.tif.volume"), "none.tif"},
        {file + ".4,4,4,uint8.volume", "60 bytes"},
        {file + ".16384,8192,8192,uint8.volume", "need 1099511627776"},
        {file + ".4,4,4,uint7.volume", "\"uint7\""},
        {file + ".volume", "cannot be opened as an image"},
    };
    for (const auto& [name, message] : cases) {
        auto result = read(name);
        EXPECT_FALSE(result.validNode());
        EXPECT_EQ(osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE, result.status()) << name;
        EXPECT_NE(std::string::npos, result.message().find(message)) << result.message();
        // Whoever called says so: a report as well would be the same sentence twice.
        EXPECT_TRUE(getLastError().ok());
    }
}

TEST_F(VolumeLoader, BadOptionsAreNamed)
{
    const std::string name = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8.volume";
    for (const char* option : {"spacing=1,2", "unit=-1", "range=2,1", "ray=sideways",
                               "table=\"no end", "orientation=LRS", "ramp=1"}) {
        auto result = read(name, option);
        EXPECT_EQ(osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE, result.status());
        const std::string text(option);
        std::string value = text.substr(text.find('=') + 1);
        if (value[0] == '"') value.erase(0, 1);
        EXPECT_NE(std::string::npos, result.message().find(text.substr(0, text.find('='))));
        EXPECT_NE(std::string::npos, result.message().find(value));
    }
    auto table = read(name, "table=nowhere.lut");
    EXPECT_NE(std::string::npos, table.message().find("nowhere.lut"));
    writeBytes("bad.lut", "0 0 0 0 2\n");
    auto bad = read(name, "table=bad.lut");
    EXPECT_NE(std::string::npos, bad.message().find("bad.lut, line 1: opacity \"2\""));
}

TEST_F(VolumeLoader, OptionsOfOthersAreLeftToThem)
{
    const std::string name = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8.volume";
    const auto volume = load(
        name, "noRotation Compressor=zlib colour=red period=0.25 WriteImageHint=\"IncludeData\"");
    ASSERT_TRUE(volume.valid());
    EXPECT_EQ(volume->getSamplingPeriod(), osg::Vec3d(0.25, 0.25, 0.25));
    EXPECT_TRUE(getLastError().ok());
}

TEST_F(VolumeLoader, EveryPropertyIsAnOption)
{
    const std::string name = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8.volume";
    fs::create_directories(path("my tables"));
    writeBytes("my tables/bone table.lut", "0 1 0 0 0\n9 0 1 0 0.5\n");
    const auto volume =
        load(name, "ray=isosurface iso=7 shading=on interpolation=cubic overlap=4 "
                   "table=\"my tables/bone table.lut\" frametime=0 material=0.1,0.2,0.3,4");
    ASSERT_TRUE(volume.valid());
    EXPECT_EQ(volume->getRayFunction(), VolumeAppearance::ISOSURFACE);
    EXPECT_EQ(volume->getIsoValue(), 7.0);
    EXPECT_TRUE(volume->getShading());
    EXPECT_EQ(volume->getTargetFrameTime(), 0.0);
    EXPECT_EQ(volume->getMaterial().specular, 0.3);
    EXPECT_EQ(volume->getVoxels()->getOverlap(), 5); // light and cubic interpolation need it
    EXPECT_EQ(volume->getLookupTable()->getFunction()->points().size(), 2u);
    const auto ramp = load(name, "ramp=0.5,0.2,0.25");
    EXPECT_EQ(ramp->getLookupTable()->getFunction()->evaluate(1.0).a, 0.25);
}

TEST_F(VolumeLoader, DefaultsPlease)
{
    const auto head =
        load(OSGVOLUMIZER_SOURCE_DIR "/data/head.tif.volume", "orientation=PIR table=head.lut");
    EXPECT_TRUE(head->getShading());
    EXPECT_GT(head->getTargetFrameTime(), 0.0);
    EXPECT_GE(head->getVoxels()->getOverlap(), head->getRequiredOverlap());
    // Upright: the first axis is backwards, the second down, the third to the right.
    const osg::Matrixd turn = osg::computeLocalToWorld(geometryOf(*head).getParentalNodePaths()[0]);
    EXPECT_EQ(osg::Vec3d(1, 0, 0) * turn, osg::Vec3d(0, 1, 0));
    EXPECT_EQ(osg::Vec3d(0, 1, 0) * turn, osg::Vec3d(0, 0, -1));
    EXPECT_EQ(osg::Vec3d(0, 0, 1) * turn, osg::Vec3d(-1, 0, 0));
    // Viewers frame the head, not the air around it.
    const osg::BoundingSphere box = geometryOf(*head).getBound(), framed = head->getBound();
    EXPECT_LT(framed.radius(), 0.8 * box.radius());
    EXPECT_GT(framed.radius(), 0.5 * box.radius());
    EXPECT_LT((framed.center() - osg::Vec3(osg::Vec3d(box.center()) * turn)).length(),
              0.3 * box.radius());
    // Noise has no surfaces that light could show.
    std::string noise(32 * 32 * 32, '\0');
    std::uint32_t state = 1;
    for (char& c : noise)
        c = static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
    const auto unlit = load(writeBytes("noise.raw", noise) + ".32,32,32,uint8.volume");
    EXPECT_FALSE(unlit->getShading());
}

TEST_F(VolumeLoader, ASliceFacesTheViewer)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x') + std::string(64, 'y'));
    for (const auto& [size, thin] :
         {std::pair<const char*, int>{"16,8,1", 2}, {"8,1,16", 1}, {"1,8,16", 0}}) {
        const auto slice = load(file + "." + size + ",uint8.volume", "spacing=2,2,2");
        ASSERT_TRUE(slice.valid()) << size;
        const osg::Matrixd turn =
            osg::computeLocalToWorld(geometryOf(*slice).getParentalNodePaths()[0]);
        osg::Vec3d axis;
        axis[thin] = 1.0;
        EXPECT_EQ(axis * turn, osg::Vec3d(0, 1, 0)) << size;
        EXPECT_FALSE(slice->getShading());
        EXPECT_EQ(slice->getOpacityUnit(), 0.25);
        const osg::BoundingBox box = geometryOf(*slice).getBoundingBox();
        EXPECT_EQ(box._max[thin] - box._min[thin], 2.0f);
    }
}

TEST_F(VolumeLoader, OtherNamesAreLeftToOthers)
{
    clearLastError();
    EXPECT_FALSE(read(path("volume")).validNode());
    EXPECT_TRUE(getLastError().ok()) << getLastError().text; // it is not ours to complain about
    EXPECT_FALSE(read(path(".volume")).validNode());
}

} // namespace VolumeLoaderTest
