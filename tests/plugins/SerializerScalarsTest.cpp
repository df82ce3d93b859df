// Scalars of tetrahedra in scene files.

#include "SerializerFixture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace SerializerScalarsTest {

using namespace osgVolumizer;

namespace {

class ScalarsTest : public SerializerTest
{
protected:
    // Five tetrahedra over eight vertices.
    static osg::ref_ptr<VolumeGeometry> makeBox()
    {
        return VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 1, 2, 3));
    }
    // All digits of single precision, both ends of its range, and no numbers.
    static std::vector<float> awkwardScalars(std::size_t count)
    {
        using Limits = std::numeric_limits<float>;
        std::vector<float> values{
            0.1f,  -1.0f / 3.0f, Limits::max(), Limits::min(), Limits::denorm_min(),
            -0.0f, NAN,          -INFINITY};
        values.resize(count, 16777217.0f);
        return values;
    }
    // Values that are no numbers are one as good as another.
    static void expectSame(const VolumeGeometry& copy, const VolumeGeometry& geometry)
    {
        ASSERT_TRUE(copy.getScalars());
        const std::vector<float>&a = *copy.getScalars(), &b = *geometry.getScalars();
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            EXPECT_TRUE((std::isnan(a[i]) && std::isnan(b[i])) ||
                        std::memcmp(&a[i], &b[i], sizeof(float)) == 0)
                << i << " " << a[i] << " " << b[i];
        EXPECT_EQ(copy.getScalarBinding(), geometry.getScalarBinding());
        EXPECT_EQ(copy.getScalarRange(), geometry.getScalarRange());
        EXPECT_EQ(copy.isScalarRangeAutomatic(), geometry.isScalarRangeAutomatic());
    }
};

} // namespace

TEST_P(ScalarsTest, KeepEveryBitAndWhatTheyBelongTo)
{
    for (const auto binding : {VolumeGeometry::PER_VERTEX, VolumeGeometry::PER_TETRAHEDRON})
        for (const bool automatic : {true, false}) {
            const auto geometry = makeBox();
            const std::size_t count = binding == VolumeGeometry::PER_VERTEX ? 8 : 5;
            ASSERT_TRUE(geometry->setScalars(awkwardScalars(count), binding));
            if (!automatic) {
                ASSERT_TRUE(geometry->setScalarRange(osg::Vec2d(-1.0 / 3.0, 0.1)));
            }
            const auto copy = roundTrip(*geometry);
            ASSERT_TRUE(copy);
            expectSame(*copy, *geometry);
        }
    EXPECT_EQ(errors(), "");
}

TEST_P(ScalarsTest, AreInTheFileOnlyWhereThereAreAny)
{
    const auto geometry = makeBox();
    const std::string without = write(*geometry);
    EXPECT_EQ(without.find("Scalar"), std::string::npos);
    const auto copy = roundTrip(*geometry);
    ASSERT_TRUE(copy);
    EXPECT_FALSE(copy->getScalars());
    EXPECT_TRUE(copy->isScalarRangeAutomatic());
    // What a shared mesh has had before is not written either.
    ASSERT_TRUE(geometry->setScalars(std::vector<float>(8, 1.0f)));
    EXPECT_NE(write(*geometry).find("Scalars"), std::string::npos);
    EXPECT_EQ(write(*geometry).find("ScalarRange"), std::string::npos);
    geometry->removeScalars();
    EXPECT_EQ(write(*geometry), without);
    EXPECT_EQ(errors(), "");
}

TEST_P(ScalarsTest, ThatAreBadAreNamedAndTheTetrahedraRead)
{
    if (GetParam() == std::string("osgb")) return; // has no text to replace
    const auto geometry = makeBox();
    ASSERT_TRUE(geometry->setScalars({11, 12, 13, 14, 15}, VolumeGeometry::PER_TETRAHEDRON));
    ASSERT_TRUE(geometry->setScalarRange(osg::Vec2d(21, 22)));
    const std::string content = write(*geometry);
    const struct
    {
        std::string from, to, words;
    } cases[] = {{"5 11 12 13 14 15", "4 11 12 13 14", "4 scalars for 5 tetrahedra"},
                 {"5 11 12 13 14 15", "6 11 12 13 14 15 16", "6 scalars for 5 tetrahedra"},
                 {"5 11 12 13 14 15", "5 11 12 x 14 15", "Scalars"},
                 {"5 11 12 13 14 15", "5 11 12 13 14 1e999", "Scalars"},
                 {"PER_TETRAHEDRON", "PER_VERTEX", "5 scalars for 8 vertices"},
                 {"PER_TETRAHEDRON", "PER_TETRAHEDRA", "ScalarBinding is 'PER_TETRAHEDRA'"},
                 {"ScalarBinding", "ScalarBondage", "ScalarBinding is missing"},
                 {"Scalars", "Scalers", "Scalars is missing, but there is ScalarBinding"},
                 {"2 21 22", "2 22 21", "the scalar range is 22 to 21"},
                 {"2 21 22", "2 21 21", "the scalar range is 21 to 21"},
                 {"2 21 22", "2 nan 22", "the scalar range is nan to 22"},
                 {"2 21 22", "1 21", "ScalarRange has 1 values instead of 2"}};
    for (const auto& c : cases) {
        std::string damaged = content;
        const std::size_t at = damaged.find(c.from);
        ASSERT_NE(at, std::string::npos) << c.from << "\n" << content;
        damaged.replace(at, c.from.size(), c.to);
        clearErrors();
        const auto object = read(damaged);
        const auto* copy = dynamic_cast<const VolumeGeometry*>(object.get());
        ASSERT_TRUE(copy) << c.to;
        EXPECT_NE(errors().find(c.words), std::string::npos) << c.to << ": " << errors();
        EXPECT_EQ(std::count(errors().begin(), errors().end(), '\n'), 1) << errors();
        EXPECT_FALSE(copy->getScalars()) << c.to;
        EXPECT_TRUE(copy->isScalarRangeAutomatic() || c.words.find("for") != std::string::npos);
        const bool isOfText = c.to.find('x') != std::string::npos || c.to.find("e9") < c.to.size();
        if (!isOfText) {
            EXPECT_EQ(copy->getTetraSet()->tetraCount(), 5u) << c.to;
        }
    }
}

TEST_P(ScalarsTest, OfTooFewBytesEndInAnError)
{
    const auto geometry = makeBox();
    ASSERT_TRUE(geometry->setScalars(awkwardScalars(8)));
    const std::string content = write(*geometry);
    const std::size_t first = content.find("Scalars") + 8;
    ASSERT_LT(first, content.size());
    for (std::size_t length = first; length < std::min(first + 60, content.size()); ++length) {
        clearErrors();
        const auto object = read(content.substr(0, length));
        const auto* copy = dynamic_cast<const VolumeGeometry*>(object.get());
        EXPECT_FALSE(copy && copy->getScalars()) << length;
        EXPECT_NE(errors(), "") << length;
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, ScalarsTest, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& p) { return std::string(p.param); });

} // namespace SerializerScalarsTest
