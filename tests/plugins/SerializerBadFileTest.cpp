#include "SerializerFixture.h"

#include "../support/LeaksOfOthers.h"

#include <osg/Group>
#include <osgDB/Registry>

#include <algorithm>
#include <optional>
#include <random>

namespace SerializerBadFileTest {

using namespace osgVolumizer;

namespace {

class BadFileTest : public SerializerTest
{
protected:
    /// A volume, then a group with three children: what must survive when the volume is damaged.
    static osg::ref_ptr<osg::Group> makeScene()
    {
        VoxelSource::Description d;
        d.size = glm::ivec3(4);
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        EXPECT_TRUE(source->allocate(d).ok());
        osg::ref_ptr<Voxels> voxels = new Voxels;
        EXPECT_TRUE(voxels->setSource(source.get()).ok());
        EXPECT_TRUE(voxels->setRange(osg::Vec2d(10.0, 20.0)).ok());
        osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        appearance->setVoxels(voxels);
        appearance->setTechnique(VolumeAppearance::SLABS);
        appearance->addChild(VolumeGeometry::createBox(*voxels));
        osg::ref_ptr<osg::Group> last = new osg::Group;
        for (int i = 0; i < 3; ++i)
            last->addChild(new osg::Group);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(appearance);
        scene->addChild(last);
        return scene;
    }
    static bool restIsThere(const osg::Object* object)
    {
        const auto* scene = dynamic_cast<const osg::Group*>(object);
        if (!scene || scene->getNumChildren() != 2) return false;
        const osg::Group* last = scene->getChild(1)->asGroup();
        return last && last->getNumChildren() == 3;
    }
    /// Replaces the first `from` that follows the first `after`.
    static std::string replaced(std::string content, const std::string& after,
                                const std::string& from, const std::string& to)
    {
        const std::size_t start = content.find(after);
        const std::size_t place =
            start == std::string::npos ? start : content.find(from, start + after.size());
        EXPECT_NE(place, std::string::npos) << after << " " << from;
        if (place == std::string::npos) return content;
        return content.replace(place, from.size(), to);
    }
};

struct Damage
{
    const char* after;
    const char* from;
    const char* to;
    const char* field; ///< what the error has to name
    const char* value; ///< and this
};

// The tokens are the same in .osgt and .osgx.
const Damage damages[] = {
    {"Vertices", "24", "23", "Vertices", "23"},
    {"Vertices", "24", "25", "Vertices", "25"},
    {"Vertices", "24", "1099511627776", "Vertices", "1099511627776"},
    {"Vertices", "24", "-1", "Vertices", "-1"},
    {"Vertices", "24", "many", "Vertices", "many"},
    {"Vertices", "24", "99999999999999999999", "Vertices", "99999999999999999999"},
    {"Vertices", "Doubles", "Strings", "Vertices", "Strings"},
    {"Vertices", "3 3 3", "3 3 nan", "vertex 7", "nan"},
    {"Vertices", "3 3 3", "inf 3 3", "vertex 7", "inf"},
    {"Vertices", "3 3 3", "3 x3 3", "Vertices", "x3"},
    {"Vertices", "3 3 3", "3 1e999 3", "Vertices", "1e999"},
    {"Tetrahedra", "0 1 2 4", "0 1 2 8", "index 3", "8"},
    {"Tetrahedra", "0 1 2 4", "0 1 2 4294967295", "index 3", "4294967295"},
    {"Tetrahedra", "0 1 2 4", "0 1 2 4294967296", "Tetrahedra", "4294967296"},
    {"Tetrahedra", "0 1 2 4", "0 -1 2 4", "Tetrahedra", "-1"},
    {"Tetrahedra", "0 1 2 4", "0 1.5 2 4", "Tetrahedra", "1.5"},
    {"Layout", "V3F", "V4F", "Layout", "V4F"},
    {"Layout", "V3F", "T3F_V3F", "index 3", "4 vertices"},
    {"Layout", "V3F", "USER", "Sizes", "missing"},
    {"Layout", "V3F", "%zz", "Layout", "%zz"},
    {"TetraSet", "Layout", "Layaut", "Layout", "missing"},
    {"TetraSet", "1 7", "1 8", "Version", "8"},
    {"TetraSet", "1 7", "1 0", "Version", "0"},
    {"TetraSet", "1 7", "2 1", "Version", "value 1 of 2"},
    {"Technique", "SLABS", "SLUBS", "Technique", "SLUBS"},
    {"Lookup", "AUTOMATIC", "MAGICAL", "Lookup", "MAGICAL"},
    {"ExactFiltering", "1 0", "1 2", "ExactFiltering", "2"},
    {"SamplingMode", "VIEWPORT", "SIDEWAYS", "SamplingMode", "SIDEWAYS"},
    {"SamplingPeriod", "1 1 1", "1 0 1", "SamplingPeriod", "0"},
    {"SamplingPeriod", "1 1 1", "1 nan 1", "SamplingPeriod", "nan"},
    {"SamplingPeriod", "3", "2", "SamplingPeriod", "its 2 values"},
    {"MaximumSamples", "4096", "0", "MaximumSamples", "0"},
    {"MaximumSamples", "4096", "5000000000", "MaximumSamples", "5000000000"},
    {"OpacityUnit", "1 0", "1 -2", "OpacityUnit", "-2"},
    {"RayFunction", "COMPOSITE", "COMPOST", "RayFunction", "COMPOST"},
    {"IsoValue", "1 0.5", "1 nan", "IsoValue", "nan"},
    {"Shading", "1 0", "1 2", "Shading", "2"},
    {"Material", "0.2 0.8", "0.2 -0.8", "Material", "-0.8"},
    {"Material", "4 0.2", "3 0.2", "Material", "its 3 values"},
    {"Gradients", "ON_THE_FLY", "ON_THE_FLOOR", "Gradients", "ON_THE_FLOOR"},
    {"AccumulationBits", "1 32", "1 12", "AccumulationBits", "12"},
    {"ErrorTolerance", "1 0", "1 -1", "ErrorTolerance", "-1"},
    {"TargetFrameTime", "1 0", "1 nan", "TargetFrameTime", "nan"},
    {"Size", "4 4 4", "0 4 4", "Size", "0"},
    {"Size", "4 4 4", "1099511627776 1 1", "Size", "1099511627776"},
    {"Size", "4 4 4", "2000000000 2000000000 2000000000", "Voxels", "64"},
    {"Size", "4 4 4", "5 4 4", "Voxels", "64"},
    {"Type", "uint8", "uint7", "Type", "uint7"},
    {"Type", "uint8", "float64", "Voxels", "64"},
    {"Components", "1 1", "1 3", "components", "3"},
    {"Origin", "0 0 0", "0 nan 0", "origin", "nan"},
    {"Voxels Bytes", "64", "1099511627776", "Voxels", "1099511627776"},
    {"Voxels Bytes", "64", "0", "Voxels", "0"},
    {"Voxels Bytes", "64", "63", "Voxels", "63"},
    {"Voxels Bytes", "64 1", "64 3", "Voxels", "3"},
    {"Voxels Bytes", "AAAA", "AA?A", "Voxels", "AA?A"},
    {"BrickSize", "256 256", "256 0", "BrickSize", "0"},
    {"BrickSize", "256 256", "256 -7", "BrickSize", "-7"},
    {"Overlap", "1 1", "1 5000", "Overlap", "5000"},
    {"Spacing Doubles 3 1 1 1", "1 1 1", "1 0 1", "spacing", "0"},
    {"Range", "10 20", "20 10", "range", "20"},
    {"Domain", "RANGE_FRACTION", "RANGE_FRICTION", "Domain", "RANGE_FRICTION"},
    {"Points", "10", "9", "Points", "9"},
};

} // namespace

TEST_P(BadFileTest, DamagedTextIsNamedAndTheRestIsRead)
{
    if (GetParam() == std::string("osgb")) return; // has no text: see the next tests
    const std::string content = write(*makeScene());
    for (const Damage& damage : damages) {
        clearErrors();
        // In XML, what follows a name is its attribute.
        std::string after = damage.after;
        if (GetParam() == std::string("osgx") && after.find(' ') != std::string::npos)
            after = after.substr(0, after.find(' ')) + " attribute=\"" +
                    after.substr(after.find(' ') + 1);
        const auto object = read(replaced(content, after, damage.from, damage.to));
        EXPECT_TRUE(restIsThere(object.get())) << damage.after << " " << damage.to;
        EXPECT_NE(errors().find(damage.field), std::string::npos)
            << damage.after << " " << damage.to << ": " << errors();
        EXPECT_NE(errors().find(damage.value), std::string::npos)
            << damage.after << " " << damage.to << ": " << errors();
        EXPECT_NE(errors().find("osgVolumizer::"), std::string::npos) << errors();
        EXPECT_EQ(std::count(errors().begin(), errors().end(), '\n'), 1) << errors();
    }
}

TEST_P(BadFileTest, DamagedBinaryIsNamedAndTheRestIsRead)
{
    if (GetParam() != std::string("osgb")) return;
    const std::string content = write(*makeScene());
    const std::string huge("\0\0\0\0\0\1\0\0", 8), nan("\0\0\0\0\0\0\xf8\x7f", 8);
    const std::string three("\0\0\0\0\0\0\x08\x40", 8), four("\4\0\0\0\0\0\0\0", 8);
    const struct
    {
        std::string after, from, to, field, value;
    } cases[] = {
        {"Vertices", std::string("\x18\0\0\0\0\0\0\0", 8), huge, "Vertices", "1099511627776"},
        {"Vertices", three, nan, "vertex 1", "nan"},
        {"Vertices", std::string(1, '\1'), std::string(1, '\7'), "kind", "7"},
        {"Tetrahedra", std::string("\1\0\0\0\2", 5), std::string("\1\0\0\1\2", 5), "index",
         "16777217"},
        {"TetraSet", "Layout", "Layaut", "Layout", "missing"},
        {"Layout", "V3F", "V4F", "Layout", "V4F"},
        {"Technique", "SLABS", "SLUBS", "Technique", "SLUBS"},
        {"Size", four, huge, "Size", "1099511627776"},
        {"Size", four, std::string(8, '\0'), "Size", "0"},
        {"Type", "uint8", "uint7", "Type", "uint7"},
        {"Origin", "Voxels", "Vorels", "Voxels", "missing"},
    };
    for (const auto& c : cases) {
        clearErrors();
        const std::string after = c.after == "TetraSet" ? "Version" : c.after;
        const auto object = read(replaced(content, after, c.from, c.to));
        EXPECT_TRUE(restIsThere(object.get())) << c.after << " " << errors();
        EXPECT_NE(errors().find(c.field), std::string::npos) << c.after << ": " << errors();
        EXPECT_NE(errors().find(c.value), std::string::npos) << c.after << ": " << errors();
    }
}

TEST_P(BadFileTest, CutFilesEndInAnError)
{
    // Cut within a record of ours. Elsewhere OSG decides: it takes a text file that ends between
    // two properties for whole, and where it is the number of a group's children that is cut off a
    // binary one, it goes on with whatever number memory happens to hold.
    const auto geometry = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 1, 2, 3));
    const std::string content = write(*geometry);
    const std::size_t first = content.find("Version", content.find("Geometry")) + 8;
    const std::size_t last =
        GetParam() == std::string("osgb") ? content.size() : content.rfind("End");
    ASSERT_LT(first, last);
    const std::size_t step = std::max<std::size_t>(1, (last - first) / 150);
    for (std::size_t length = first; length < last; length += step) {
        writeFile(std::string("scene.") + GetParam(), content.substr(0, length));
        clearErrors();
        osgDB::ReaderWriter::ReadResult result =
            osgDB::Registry::instance()->readObject(scene(), nullptr);
        // XML is read whole before it is looked at, and what there is of it is an object.
        if (GetParam() != std::string("osgx")) {
            EXPECT_FALSE(result.success()) << length;
            EXPECT_FALSE(result.getObject()) << length;
        }
        EXPECT_NE(errors().find("field"), std::string::npos) << length << " " << errors();
    }
}

TEST_P(BadFileTest, CutTextOfAWholeSceneIsSurvived)
{
    if (GetParam() == std::string("osgb")) return; // see above
    const std::string content = write(*makeScene());
    std::size_t damaged = 0;
    // Of XML that ends after the "<" behind a reference to a group OSG makes a group that is in
    // itself, and so is never let go of.
    std::optional<test::LeaksOfOthers> cycles;
    if (GetParam() == std::string("osgx")) cycles.emplace();
    // An empty file is no case for us: OSG does not know its format, and leaks its options.
    for (std::size_t length = 17; length < content.size(); length += 17)
        damaged += !restIsThere(read(content.substr(0, length)).get());
    EXPECT_GT(damaged, content.size() / 17 / 2);
}

TEST_P(BadFileTest, RandomDamageIsSurvived)
{
    // The geometry alone: from the record on, all bytes are ours.
    const auto geometry = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 1, 2, 3));
    const std::string content = write(*geometry);
    const std::size_t start = content.find("Version", content.find("Geometry"));
    ASSERT_NE(start, std::string::npos);
    std::mt19937 random(99);
    int different = 0;
    for (int i = 0; i < 400; ++i) {
        std::string damaged = content;
        for (int n = 0; n < 1 + i % 4; ++n)
            damaged[start + random() % (content.size() - start)] = static_cast<char>(random());
        clearErrors();
        const auto object = read(damaged);
        const auto* copy = dynamic_cast<const VolumeGeometry*>(object.get());
        EXPECT_TRUE(!copy || copy->getTetraSet()->validate().ok());
        different += !copy || !errors().empty();
    }
    EXPECT_GT(different, 50);
}

INSTANTIATE_TEST_SUITE_P(Formats, BadFileTest, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& p) { return std::string(p.param); });

} // namespace SerializerBadFileTest
