// Small scene files that ask for what would hang, take all memory, or mean nothing: one message,
// at once, and the rest of the scene is there.

#include "SerializerFixture.h"

#include "../support/Watchdog.h"

#include <osg/Group>

#include <algorithm>
#include <array>

#include <sys/stat.h>
#include <unistd.h>

namespace HostileSceneTest {

using namespace osgVolumizer;

namespace {

class HostileSceneTest : public SerializerTest
{
protected:
    /// A volume that refers to files, and something else.
    static osg::ref_ptr<osg::Group> makeScene(const std::string& voxelFile,
                                              const std::string& tableFile)
    {
        VoxelSource::Description d;
        d.size = {128, 128, 84};
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        EXPECT_TRUE(source->allocate(d));
        osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        voxels->setFileName(voxelFile);
        appearance->setVoxels(voxels);
        appearance->getLookupTable()->setFileName(tableFile);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(appearance);
        scene->addChild(new osg::Group);
        return scene;
    }
    static VolumeAppearance* volumeOf(const osg::ref_ptr<osg::Object>& object)
    {
        auto* scene = dynamic_cast<osg::Group*>(object.get());
        if (!scene || scene->getNumChildren() != 2) return nullptr;
        return dynamic_cast<VolumeAppearance*>(scene->getChild(0));
    }
    std::string dataFile(const std::string& name) const
    {
        return std::string(OSGVOLUMIZER_SOURCE_DIR) + "/data/" + name;
    }
    std::string makePipe(const std::string& name) const
    {
        ::unlink(path(name).c_str());
        EXPECT_EQ(mkfifo(path(name).c_str(), 0600), 0);
        return path(name);
    }
    static std::string replaced(std::string content, const std::string& from, const std::string& to)
    {
        const std::size_t place = content.find(from);
        EXPECT_NE(place, std::string::npos) << from;
        return place == std::string::npos ? content : content.replace(place, from.size(), to);
    }
    void expectOneError(const std::string& what) const
    {
        EXPECT_NE(errors().find(what), std::string::npos) << what << ": " << errors();
        EXPECT_EQ(std::count(errors().begin(), errors().end(), '\n'), 1) << errors();
    }

    osgVolumizer::support::Watchdog _watchdog;
};

} // namespace

TEST_P(HostileSceneTest, PipesAndDevices)
{
    for (const std::string& file :
         {makePipe("pipe.tif"), makePipe("pipe.raw") + ".2,2,2,uint8", std::string("/dev/zero")}) {
        clearErrors();
        EXPECT_NE(volumeOf(read(write(*makeScene(file, dataFile("head.lut"))))), nullptr);
        expectOneError("is no regular file");
    }
    for (const std::string& file : {makePipe("pipe.lut"), std::string("/dev/zero")}) {
        clearErrors();
        EXPECT_NE(volumeOf(read(write(*makeScene(dataFile("head.tif"), file)))), nullptr);
        expectOneError("is no regular file");
    }
}

TEST_P(HostileSceneTest, BricksWithoutEnd)
{
    if (GetParam() != std::string("osgt")) return; // what follows edits text
    const std::string content = write(*makeScene(dataFile("head.tif"), dataFile("head.lut")));
    const std::string whole = "BrickSize Integers 3 256 256 256";
    for (const auto& [size, overlap, what] :
         {std::array<std::string, 3>{"64 64 64", "63", "overlap 63"},
          std::array<std::string, 3>{"2 2 2", "1", "1338707 bricks"}}) {
        clearErrors();
        std::string changed = replaced(content, whole, "BrickSize Integers 3 " + size);
        changed = replaced(changed, "Overlap Integers 1 1", "Overlap Integers 1 " + overlap);
        changed = replaced(changed, "Spacing Doubles 3 1 1 1", "Spacing Doubles 3 1 2 3");
        VolumeAppearance* volume = nullptr;
        const auto scene = read(changed);
        ASSERT_NE(volume = volumeOf(scene), nullptr);
        expectOneError(what);
        EXPECT_LE(volume->getVoxels()->getLayout().brickCount(), 18);
        EXPECT_EQ(volume->getVoxels()->getSpacing(), osg::Vec3d(1.0, 2.0, 3.0));
    }
}

TEST_P(HostileSceneTest, NumbersWithoutMeaning)
{
    if (GetParam() != std::string("osgt")) return;
    const std::string content = write(*makeScene(dataFile("head.tif"), dataFile("head.lut")));
    const struct
    {
        std::string from, to, named;
    } cases[] = {
        {"SamplingPeriod Doubles 3 1 1 1", "SamplingPeriod Doubles 3 1 1e300 1", "1e+300"},
        {"SamplingPeriod Doubles 3 1 1 1", "SamplingPeriod Doubles 3 1 1 1e-300", "1e-300"},
        {"OpacityUnit Doubles 1 0", "OpacityUnit Doubles 1 1e-300", "1e-300"},
        {"OpacityUnit Doubles 1 0", "OpacityUnit Doubles 1 1e300", "1e+300"},
        {"Material Doubles 4 0.2", "Material Doubles 4 1e300", "1e+300"},
        {"0.3 32", "0.3 1e300", "1e+300"},
        {"Spacing Doubles 3 1 1 1", "Spacing Doubles 3 1 1 1e-300", "1e-300"},
        {"Origin Doubles 3 0 0 0", "Origin Doubles 3 0 1e300 0", "1e+300"},
    };
    for (const auto& c : cases) {
        clearErrors();
        EXPECT_NE(volumeOf(read(replaced(content, c.from, c.to))), nullptr) << c.to;
        expectOneError(c.named);
    }
    clearErrors();
    const auto scene = read(replaced(content, "MaximumSamples Integers 1 4096",
                                     "MaximumSamples Integers 1 2147483647"));
    ASSERT_NE(volumeOf(scene), nullptr);
    EXPECT_EQ(volumeOf(scene)->getMaximumSamples(), 2147483647);
    EXPECT_EQ(errors(), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileSceneTest, testing::Values("osgt", "osgb", "osgx"));

} // namespace HostileSceneTest
