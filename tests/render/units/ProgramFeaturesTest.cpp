#include <osgVolumizer/render/draw/ProgramFeatures.h>

#include <gtest/gtest.h>

#include <iterator>
#include <set>
#include <vector>

namespace ProgramFeaturesTest {

using namespace osgVolumizer;
using render::ProgramFeatures;
using render::ProgramFlags;

namespace {

// All that differ from the default in one thing.
std::vector<ProgramFeatures> variants()
{
    std::vector<ProgramFeatures> all;
    // Flags are all that the base has.
    for (std::size_t i = 0; i < sizeof(ProgramFlags) / sizeof(bool); ++i) {
        ProgramFeatures features;
        bool& flag = reinterpret_cast<bool*>(static_cast<ProgramFlags*>(&features))[i];
        flag = !flag;
        all.push_back(features);
    }
    for (std::size_t i = 1; i < std::size(VolumeAppearance::RAY_FUNCTION_NAMES); ++i) {
        all.emplace_back();
        all.back().rayFunction = static_cast<VolumeAppearance::RayFunction>(i);
    }
    for (int i = 1; i <= 6; ++i) {
        all.emplace_back();
        all.back().slotCount = 4 * i;
    }
    for (int i = 1; i <= 4; ++i) {
        all.emplace_back();
        all.back().paintCount = i;
    }
    for (int i : {1, 2, 63, 64, 1000}) {
        all.emplace_back();
        all.back().planeCount = i;
    }
    return all;
}

} // namespace

TEST(ProgramFeatures, DifferentOnesHaveDifferentKeys)
{
    std::set<std::uint64_t> keys{ProgramFeatures().key()};
    for (const ProgramFeatures& features : variants())
        EXPECT_TRUE(keys.insert(features.key()).second);
}

TEST(ProgramFeatures, EveryFlagIsDefinedForTheShader)
{
    std::set<std::string> texts{ProgramFeatures().defines()};
    for (const ProgramFeatures& features : variants()) {
        if (features.rayFunction != VolumeAppearance::COMPOSITE || features.paintCount > 1)
            continue; // said by the shader's own files
        EXPECT_TRUE(texts.insert(features.defines()).second) << features.defines();
    }
}

TEST(ProgramFeatures, DefinesAreLines)
{
    ProgramFeatures features;
    features.slotCount = 8;
    features.planeCount = 3;
    features.paintCount = 2;
    features.cubic = true;
    EXPECT_EQ(features.defines(), "#define SLAB\n#define VOXELS\n#define CUBIC\n#define FETCH\n"
                                  "#define PAINTED\n#define SLOTS 8\n#define PLANES 3\n");
}

} // namespace ProgramFeaturesTest
