#include "SerializerFixture.h"

#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/VolumeSlice.h>
#include <osgVolumizer/interact/Sculpt.h>

#include <osg/MatrixTransform>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace SerializerTests {

using namespace osgVolumizer;

namespace {

// Numbers that need all their digits, and the ends of the range.
std::vector<double> awkwardNumbers()
{
    std::vector<double> values{0.1,
                               -1.0 / 3.0,
                               6.4e6 + 1e-9,
                               std::nextafter(1.0, 2.0),
                               core::TetraSet::MAX_MAGNITUDE,
                               std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::denorm_min(),
                               -0.0,
                               123456789012345678.0,
                               1e22};
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
    std::uniform_int_distribution<int> exponent(-300, 95);
    while (values.size() < 60)
        values.push_back(std::ldexp(mantissa(random), exponent(random)));
    return values;
}

bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

osg::ref_ptr<Voxels> makeVoxels(VoxelType type, int components, const glm::ivec3& size)
{
    VoxelSource::Description d;
    d.size = size;
    d.type = type;
    d.components = components;
    d.spacing = glm::dvec3(0.1, 1.0 / 3.0, 2.0);
    d.origin = glm::dvec3(-0.7, 6.4e6 + 0.1, 1e-9);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(d).ok());
    auto* bytes = static_cast<unsigned char*>(source->data());
    std::mt19937 random(5);
    for (std::size_t i = 0; i < source->sizeInBytes(); ++i)
        bytes[i] = static_cast<unsigned char>(random());
    osg::ref_ptr<Voxels> voxels = new Voxels;
    EXPECT_TRUE(voxels->setSource(source.get()).ok());
    return voxels;
}

bool sameVoxels(const Voxels& a, const Voxels& b)
{
    const auto* x = dynamic_cast<const MemoryVoxelSource*>(a.getSource());
    const auto* y = dynamic_cast<const MemoryVoxelSource*>(b.getSource());
    return x && y && x->sizeInBytes() == y->sizeInBytes() &&
           std::memcmp(x->data(), y->data(), x->sizeInBytes()) == 0;
}

enum Oddity
{
    NO_ODDITY,
    FAILS,
    PAGED
};

class UnknownSource : public VoxelSource
{
public:
    META_Object(osgVolumizerTests, UnknownSource);
    explicit UnknownSource(Oddity oddity = NO_ODDITY) : _oddity(oddity) {}
    UnknownSource(const UnknownSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _oddity(o._oddity)
    {
    }
    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(3, 4, 5);
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        if (_oddity == FAILS) return {ErrorCode::FILE_UNREADABLE, "no such luck"};
        const glm::ivec3 n = region.size();
        std::memset(destination, 77, std::size_t(n.x * n.y * n.z));
        return {};
    }
    int levelCount() const override { return _oddity == PAGED ? 2 : 1; }

private:
    Oddity _oddity;
};

} // namespace

TEST_P(SerializerTest, SlicesKeepAllThatIsSet)
{
    const osg::ref_ptr<VolumeSlice> made = new VolumeSlice;
    VolumeSlice& slice = *made;
    ASSERT_TRUE(slice.setPlane(osg::Vec4d(0.1, -2.0, 0.3, 1.0 / 3.0)));
    ASSERT_TRUE(slice.setThickness(0.1));
    ASSERT_TRUE(slice.setSamplingPeriod(1.0 / 3.0));
    ASSERT_TRUE(slice.setOpacity(0.7));
    ASSERT_TRUE(slice.setWindow(-0.1, 1e-3));
    slice.setReduction(VolumeSlice::MINIMUM);
    slice.setInterpolation(VolumeAppearance::CUBIC);
    slice.setExactFiltering(true);
    slice.setUsesTableOpacity(true);
    slice.setFollowsCut(true);
    slice.setRegion(VolumeGeometry::createBox(osg::BoundingBoxd(1, 2, 3, 4, 5, 6)));
    osg::ref_ptr<VolumeSlice> copy = roundTrip(slice);
    ASSERT_TRUE(copy.valid()) << errors();
    EXPECT_EQ(copy->getShape(), VolumeSlice::PLANE);
    EXPECT_EQ(copy->getPlane(), slice.getPlane());
    EXPECT_EQ(copy->getThickness(), 0.1);
    EXPECT_EQ(copy->getSamplingPeriod(), 1.0 / 3.0);
    EXPECT_EQ(copy->getOpacity(), 0.7);
    ASSERT_TRUE(copy->getWindow());
    EXPECT_EQ(*copy->getWindow(), osg::Vec2d(-0.1, 1e-3));
    EXPECT_EQ(copy->getReduction(), VolumeSlice::MINIMUM);
    EXPECT_EQ(copy->getInterpolation(), VolumeAppearance::CUBIC);
    EXPECT_TRUE(copy->getExactFiltering() && copy->getUsesTableOpacity());
    EXPECT_TRUE(copy->getFollowsCut());
    ASSERT_TRUE(copy->getRegion());
    EXPECT_EQ(copy->getRegion()->getTetraSet()->tetraCount(), 5u);

    const std::vector<osg::Vec3d> corners = {{0.1, 0, 3}, {5, 0, 3}, {5, 1.0 / 3.0, 3}, {2, 4, 3}};
    ASSERT_TRUE(slice.setPolygon(corners));
    slice.setLookupTable(new LookupTable);
    slice.getLookupTable()->setName("own");
    copy = roundTrip(slice);
    ASSERT_TRUE(copy.valid() && copy->getShape() == VolumeSlice::POLYGON) << errors();
    EXPECT_EQ(copy->getPolygon(), corners);
    ASSERT_TRUE(copy->getLookupTable());
    EXPECT_EQ(copy->getLookupTable()->getName(), "own");
    EXPECT_FALSE(copy->getWindow());

    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (const osg::Vec3& p : {osg::Vec3(0, 0, 0), {3, 0, 0}, {0, 3, 1}})
        points->push_back(p);
    geometry->setVertexArray(points);
    geometry->setTexCoordArray(1, new osg::Vec3Array(*points));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    ASSERT_TRUE(slice.setGeometry(geometry, 1));
    copy = roundTrip(slice);
    ASSERT_TRUE(copy.valid() && copy->getGeometry()) << errors();
    EXPECT_EQ(copy->getShape(), VolumeSlice::GEOMETRY);
    EXPECT_EQ(copy->getPlaceUnit(), 1);
    EXPECT_EQ(errors(), "");
}

TEST_P(SerializerTest, ASliceThatIsDamagedKeepsItsDefaults)
{
    const osg::ref_ptr<VolumeSlice> made = new VolumeSlice;
    VolumeSlice& slice = *made;
    ASSERT_TRUE(slice.setThickness(0.123456789));
    ASSERT_TRUE(slice.setOpacity(0.5));
    std::string content = write(slice);
    const std::size_t at = content.find("0.123456789");
    if (at == std::string::npos) return; // a binary file
    content.replace(at, 11, "-1.23456789");
    const auto read1 = read(content);
    const auto* copy = dynamic_cast<const VolumeSlice*>(read1.get());
    ASSERT_TRUE(copy);
    EXPECT_EQ(copy->getThickness(), 0.0);
    EXPECT_EQ(copy->getOpacity(), 0.5);
    EXPECT_NE(errors().find("thickness is -1.23456789"), std::string::npos) << errors();
}

TEST_P(SerializerTest, TetraSetsKeepEveryBitInEveryLayout)
{
    using core::VertexFormat;
    using core::VertexLayout;
    std::vector<VertexFormat> formats;
    for (int layout = 0; layout < 6; ++layout)
        formats.emplace_back(static_cast<VertexLayout>(layout));
    formats.push_back(VertexFormat::user(3, 4, 2));
    formats.push_back(VertexFormat::user(0, 3, 16));
    const std::vector<double> numbers = awkwardNumbers();
    for (const VertexFormat& format : formats) {
        core::TetraSet set;
        set.vertices = core::VertexArray(format);
        set.vertices.resize(6);
        for (std::size_t i = 0; i < set.vertices.values().size(); ++i)
            set.vertices.values()[i] = numbers[i % numbers.size()];
        set.indices = {0, 1, 2, 3, 5, 4, 3, 2, 0, 0, 0, 0};
        osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
        geometry->setName("a \"name\" \\ with blanks");
        geometry->setNodeMask(0xf0f);
        ASSERT_TRUE(geometry->setTetraSet(set).ok());
        ASSERT_TRUE(geometry->setSlackAngle(0.1 * format.stride()));
        const auto copy = roundTrip(*geometry);
        ASSERT_TRUE(copy);
        EXPECT_EQ(copy->getTetraSet()->vertices.format().layout, format.layout);
        EXPECT_TRUE(copy->getTetraSet()->vertices.format() == format);
        EXPECT_TRUE(sameBits(copy->getTetraSet()->vertices.values(), set.vertices.values()));
        EXPECT_EQ(copy->getTetraSet()->indices, set.indices);
        EXPECT_EQ(copy->getSlackAngle(), geometry->getSlackAngle());
        EXPECT_EQ(copy->getName(), geometry->getName());
        EXPECT_EQ(copy->getNodeMask(), geometry->getNodeMask());
    }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, EmptyObjectsComeBackEmpty)
{
    const auto geometry = roundTrip(*osg::ref_ptr<VolumeGeometry>(new VolumeGeometry));
    ASSERT_TRUE(geometry);
    EXPECT_TRUE(geometry->getTetraSet()->empty());
    const auto appearance = roundTrip(*osg::ref_ptr<VolumeAppearance>(new VolumeAppearance));
    ASSERT_TRUE(appearance);
    EXPECT_FALSE(appearance->getVoxels());
    osg::ref_ptr<VolumeAppearance> without = new VolumeAppearance;
    without->setVoxels(new Voxels);
    const auto copy = roundTrip(*without);
    ASSERT_TRUE(copy && copy->getVoxels());
    EXPECT_FALSE(copy->getVoxels()->valid());
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, AppearancesKeepTheirSampling)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    for (const auto technique :
         {VolumeAppearance::AUTOMATIC, VolumeAppearance::SLICES, VolumeAppearance::SLABS})
        for (int i = 0; i < 3; ++i) {
            a->setTechnique(technique);
            a->setInterpolation(static_cast<VolumeAppearance::Interpolation>(i));
            a->setLookup(static_cast<VolumeAppearance::Lookup>(i + 1));
            a->setExactFiltering(i == 1);
            a->setSamplingMode(static_cast<SamplingMode>(i));
            a->setSamplingSpace(static_cast<SamplingSpace>(2 - i));
            ASSERT_TRUE(a->setSamplingPeriod(osg::Vec3d(0.1, 1.0 / 3.0, 7.0 + i)).ok());
            ASSERT_TRUE(a->setMaximumSamples(1000 + i).ok());
            ASSERT_TRUE(a->setOpacityUnit(0.1 * i).ok());
            const auto b = roundTrip(*a);
            ASSERT_TRUE(b);
            EXPECT_EQ(b->getTechnique(), a->getTechnique());
            EXPECT_EQ(b->getInterpolation(), a->getInterpolation());
            EXPECT_EQ(b->getLookup(), a->getLookup());
            EXPECT_EQ(b->getExactFiltering(), a->getExactFiltering());
            EXPECT_EQ(b->getSamplingMode(), a->getSamplingMode());
            EXPECT_EQ(b->getSamplingSpace(), a->getSamplingSpace());
            EXPECT_EQ(b->getSamplingPeriod(), a->getSamplingPeriod());
            EXPECT_EQ(b->getMaximumSamples(), a->getMaximumSamples());
            EXPECT_EQ(b->getOpacityUnit(), a->getOpacityUnit());
        }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, AppearancesKeepRayFunctionsAndShading)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    const int bits[] = {8, 16, 32};
    for (int i = 0; i <= VolumeAppearance::ISOSURFACE; ++i) {
        a->setRayFunction(static_cast<VolumeAppearance::RayFunction>(i));
        ASSERT_TRUE(a->setIsoValue(-1.0 / 3.0 + i).ok());
        a->setShading(i % 2 == 0);
        ASSERT_TRUE(a->setMaterial({0.1 * i, 1.0 / 3.0, 0.3 + i, 0.7 * i}).ok());
        a->setGradients(static_cast<VolumeAppearance::Gradients>(i % 2));
        a->setCombineRule(static_cast<VolumeAppearance::CombineRule>(i % 2));
        ASSERT_TRUE(a->setAccumulationBits(bits[i % 3]).ok());
        ASSERT_TRUE(a->setErrorTolerance(1e-3 * i / 3.0).ok());
        ASSERT_TRUE(a->setTargetFrameTime(i / 60.0).ok());
        const auto b = roundTrip(*a);
        ASSERT_TRUE(b);
        EXPECT_EQ(b->getRayFunction(), a->getRayFunction());
        EXPECT_EQ(b->getIsoValue(), a->getIsoValue());
        EXPECT_EQ(b->getShading(), a->getShading());
        EXPECT_EQ(b->getMaterial().ambient, a->getMaterial().ambient);
        EXPECT_EQ(b->getMaterial().diffuse, a->getMaterial().diffuse);
        EXPECT_EQ(b->getMaterial().specular, a->getMaterial().specular);
        EXPECT_EQ(b->getMaterial().shininess, a->getMaterial().shininess);
        EXPECT_EQ(b->getGradients(), a->getGradients());
        EXPECT_EQ(b->getCombineRule(), a->getCombineRule());
        EXPECT_EQ(b->getAccumulationBits(), a->getAccumulationBits());
        EXPECT_EQ(b->getErrorTolerance(), a->getErrorTolerance());
        EXPECT_EQ(b->getTargetFrameTime(), a->getTargetFrameTime());
    }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, SeriesAreKeptWithHowTheyArePlayed)
{
    for (int step = 0; step < 3; ++step)
        writeFile("v" + std::to_string(step) + ".raw", std::string(24, static_cast<char>(step)));
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("series=on");
    const auto read = readVoxels(path("v%d.raw") + ".2,3,4,uint8", options.get());
    ASSERT_TRUE(read.ok()) << read.status.text;
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(read->get());
    ASSERT_TRUE(a->setTimeStep(1.0 / 3.0));
    ASSERT_TRUE(a->setTimeRate(-12.5));
    a->setTimeBlending(true);
    ASSERT_TRUE(a->getVoxels()->setTextureBudget(3 << 20));
    ASSERT_TRUE(a->getVoxels()->setPartialBricks(core::PartialBricks::AVERAGE_UP));
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b && b->getVoxels()) << errors();
    EXPECT_EQ(b->getTimeStep(), 1.0 / 3.0);
    EXPECT_EQ(b->getTimeRate(), -12.5);
    EXPECT_TRUE(b->getTimeBlending());
    EXPECT_EQ(b->getVoxels()->getStepCount(), 3);
    EXPECT_EQ(b->getVoxels()->getTextureBudget(), 3 << 20);
    EXPECT_EQ(b->getVoxels()->getPartialBricks(), core::PartialBricks::AVERAGE_UP);
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, PickOpacityIsKept)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    ASSERT_TRUE(a->setPickOpacity(0.05));
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b) << errors();
    EXPECT_EQ(b->getPickOpacity(), 0.05);
}

// Version 2 had none of these: what is not in the file keeps its default, and nothing is missed.
TEST_P(SerializerTest, OlderVersionsKeepDefaults)
{
    if (GetParam() == std::string("osgb")) return; // has no text
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setTechnique(VolumeAppearance::SLICES);
    a->setShading(true);
    std::string content = write(*a);
    const std::size_t version =
        content.find("1 7", content.find("Version", content.find("Sampling")));
    ASSERT_NE(version, std::string::npos);
    content[version + 2] = '2';
    const auto read = SerializerTest::read(content);
    const auto* b = dynamic_cast<const VolumeAppearance*>(read.get());
    ASSERT_TRUE(b);
    EXPECT_EQ(b->getTechnique(), VolumeAppearance::SLICES);
    EXPECT_FALSE(b->getShading());
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, InlineVoxelsKeepEveryByteOfEveryType)
{
    for (int type = 0; type <= static_cast<int>(VoxelType::FLOAT64); ++type)
        for (const int components : {1, 4}) {
            osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
            a->setVoxels(makeVoxels(static_cast<VoxelType>(type), components, {5, 3, 7}));
            ASSERT_TRUE(a->getVoxels()->setBrickSize({4, 3, 2}).ok());
            ASSERT_TRUE(a->getVoxels()->setRange(osg::Vec2d(-0.1, 1.0 / 3.0)).ok());
            const auto b = roundTrip(*a);
            ASSERT_TRUE(b && b->getVoxels());
            const Voxels &x = *a->getVoxels(), &y = *b->getVoxels();
            EXPECT_EQ(y.getSize(), x.getSize());
            EXPECT_EQ(y.getType(), x.getType());
            EXPECT_EQ(y.getComponents(), x.getComponents());
            EXPECT_EQ(y.getSpacing(), x.getSpacing());
            EXPECT_EQ(y.getOrigin(), x.getOrigin());
            EXPECT_EQ(y.getRange(), x.getRange());
            EXPECT_TRUE(y.hasExplicitRange());
            EXPECT_EQ(y.getBrickSize(), x.getBrickSize());
            EXPECT_EQ(y.getOverlap(), x.getOverlap());
            EXPECT_TRUE(sameVoxels(x, y)) << voxelTypeName(x.getType());
        }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, VoxelsOfAFileCanBeWrittenInline)
{
    std::string bytes;
    for (int i = 0; i < 5 * 3 * 7; ++i)
        bytes += static_cast<char>(2 * i);
    writeFile("v.raw", bytes);
    const auto read = readVoxels(path("v.raw") + ".5,3,7,uint8");
    ASSERT_TRUE(read.ok()) << read.status.text;
    (*read)->setFileName("");
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(read->get());
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b && b->getVoxels() && b->getVoxels()->valid()) << errors();
    const auto* source = dynamic_cast<const MemoryVoxelSource*>(b->getVoxels()->getSource());
    ASSERT_TRUE(source && source->sizeInBytes() == bytes.size());
    EXPECT_EQ(std::memcmp(source->data(), bytes.data(), bytes.size()), 0);
}

// The file has them as they were: they are written inline, and keep their range.
TEST_P(SerializerTest, SculptedVoxelsAreInTheScene)
{
    std::vector<float> values;
    for (int i = 0; i < 5 * 6 * 7; ++i)
        values.push_back(0.5f + 0.01f * float(i));
    writeFile("v.raw", std::string(reinterpret_cast<const char*>(values.data()),
                                   values.size() * sizeof(float)));
    const auto read = readVoxels(path("v.raw") + ".5,6,7,float32");
    ASSERT_TRUE(read.ok()) << read.status.text;
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(read->get());
    ASSERT_TRUE(makeEditable(**read).ok());
    const auto same = roundTrip(*a);
    ASSERT_TRUE(same && same->getVoxels()) << errors();
    EXPECT_FALSE(same->getVoxels()->getFileName().empty()); // nothing has changed yet
    const osg::Vec2d range = (*read)->getRange();
    Sculptor sculptor(read->get());
    Sculptor::Tool tool;
    tool.operation = Sculptor::Operation::ERASE;
    tool.erased = -3.0;
    tool.radius = osg::Vec3d(2.0, 2.0, 2.0);
    ASSERT_TRUE(sculptor.setTool(tool).ok());
    ASSERT_TRUE(sculptor.stroke({{2.0, 3.0, 3.0}}).ok());
    ASSERT_TRUE((*read)->getSource()->read({{0, 0, 0}, {5, 6, 7}}, values.data()).ok());
    EXPECT_EQ(values[2 + 5 * (3 + 6 * 3)], -3.0f);
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b && b->getVoxels() && b->getVoxels()->valid()) << errors();
    EXPECT_TRUE(b->getVoxels()->getFileName().empty());
    const auto* source = dynamic_cast<const MemoryVoxelSource*>(b->getVoxels()->getSource());
    ASSERT_TRUE(source && source->sizeInBytes() == values.size() * sizeof(float));
    EXPECT_EQ(std::memcmp(source->data(), values.data(), source->sizeInBytes()), 0);
    EXPECT_EQ(b->getVoxels()->getRange(), range);
    EXPECT_TRUE(errors().empty()) << errors();
}

// A class that no scene file knows: its voxels are written; where they cannot be read, or are too
// large for that, nothing is.
TEST_P(SerializerTest, VoxelsOfAnyClassAreWrittenOrTheSceneIsNot)
{
    for (const Oddity oddity : {NO_ODDITY, FAILS, PAGED}) {
        clearErrors();
        const osg::ref_ptr<Voxels> voxels = new Voxels(new UnknownSource(oddity));
        osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        appearance->setVoxels(voxels);
        std::filesystem::remove(scene());
        const bool written = osgDB::writeObjectFile(*appearance, scene());
        EXPECT_EQ(written, oddity == NO_ODDITY) << oddity;
        EXPECT_EQ(errors().empty(), oddity == NO_ODDITY) << errors();
        const char* const words[] = {"", "no such luck", "UnknownSource"};
        EXPECT_NE(errors().find(words[oddity]), std::string::npos) << errors();
        if (!written) continue;
        const auto copy = osgDB::readRefFile<VolumeAppearance>(scene());
        ASSERT_TRUE(copy && copy->getVoxels());
        const auto block = copy->getVoxels()->getBrick(0);
        ASSERT_EQ(block.bytes, 60u);
        EXPECT_EQ(block.data[7], 77);
    }
}

TEST_P(SerializerTest, MoreThanOneChunkOfVoxels)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(makeVoxels(VoxelType::UINT16, 1, {101, 97, 131})); // 2.5 MB
    ASSERT_TRUE(a->getVoxels()->setOverlap(3).ok());
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b && b->getVoxels());
    EXPECT_TRUE(sameVoxels(*a->getVoxels(), *b->getVoxels()));
    EXPECT_EQ(b->getVoxels()->getOverlap(), 3);
    EXPECT_FALSE(b->getVoxels()->hasExplicitRange());
}

TEST_P(SerializerTest, SharedVoxelsStayShared)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    const auto voxels = makeVoxels(VoxelType::UINT8, 1, {4, 4, 4});
    for (int i = 0; i < 2; ++i) {
        osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
        a->setVoxels(voxels);
        a->addChild(VolumeGeometry::createBox(*voxels));
        osg::ref_ptr<osg::MatrixTransform> turn = new osg::MatrixTransform;
        turn->addChild(a);
        group->addChild(turn);
    }
    const auto copy = roundTrip(*group);
    ASSERT_TRUE(copy);
    ASSERT_EQ(copy->getNumChildren(), 2u);
    const VolumeAppearance* a[2];
    for (unsigned i = 0; i < 2; ++i) {
        a[i] = dynamic_cast<const VolumeAppearance*>(copy->getChild(i)->asGroup()->getChild(0));
        ASSERT_TRUE(a[i] && a[i]->getNumChildren() == 1);
        EXPECT_TRUE(dynamic_cast<const VolumeGeometry*>(a[i]->getChild(0)));
    }
    EXPECT_EQ(a[0]->getVoxels(), a[1]->getVoxels());
    EXPECT_NE(a[0]->getLookupTable(), a[1]->getLookupTable());
}

TEST_P(SerializerTest, LookupTablesKeepEveryBit)
{
    LookupPoints points;
    double value = -1000.0;
    for (int i = 0; i < 40; ++i) {
        const double c = std::fmod(0.1 * i + 1.0 / 3.0, 1.0);
        points.push_back({value, glm::dvec4(c, 1.0 - c, c * c, std::sqrt(c))});
        if (i % 3) value += 0.1; // jumps between
    }
    for (const auto domain : {LookupTable::RANGE_FRACTION, LookupTable::DATA_VALUES}) {
        osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
        ASSERT_TRUE(a->getLookupTable()->setPoints(points, domain).ok());
        const auto b = roundTrip(*a);
        ASSERT_TRUE(b);
        EXPECT_EQ(b->getLookupTable()->getDomain(), domain);
        const LookupPoints& copy = b->getLookupTable()->getFunction()->points();
        ASSERT_EQ(copy.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(copy[i].value, points[i].value);
            EXPECT_EQ(copy[i].color, points[i].color);
        }
    }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, LookupTablesByFileAreFoundBesideTheScene)
{
    writeFile("a table--1.lut", "0 0 0 0 0\n100 1 0.5 0.25 0.75\n");
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->getLookupTable()->setFileName("a table--1.lut");
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b);
    EXPECT_EQ(b->getLookupTable()->getFileName(), "a table--1.lut");
    EXPECT_EQ(b->getLookupTable()->getDomain(), LookupTable::DATA_VALUES);
    EXPECT_EQ(b->getLookupTable()->getFunction()->evaluate(100.0),
              glm::dvec4(1.0, 0.5, 0.25, 0.75));
    EXPECT_TRUE(errors().empty()) << errors();

    a->getLookupTable()->setFileName("missing.lut");
    const auto c = roundTrip(*a);
    ASSERT_TRUE(c);
    EXPECT_NE(errors().find("missing.lut"), std::string::npos) << errors();
    EXPECT_EQ(c->getLookupTable()->getFileName(), "missing.lut");
}

TEST_P(SerializerTest, VoxelsByFileAreFoundBesideTheScene)
{
    std::string samples;
    for (int i = 0; i < 2 * 3 * 4; ++i)
        samples += static_cast<char>(10 * i);
    writeFile("a scan.raw", samples);
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(new Voxels);
    a->getVoxels()->setFileName("a scan.raw.2,3,4,uint8");
    a->getVoxels()->setFileOptions("spacing=1,2,0.5 range=5,200");
    ASSERT_TRUE(a->getVoxels()->setSpacing(osg::Vec3d(1.0, 2.0, 0.5)).ok());
    const auto b = roundTrip(*a);
    ASSERT_TRUE(b && b->getVoxels());
    EXPECT_TRUE(errors().empty()) << errors();
    EXPECT_EQ(b->getVoxels()->getSize(), osg::Vec3i(2, 3, 4));
    EXPECT_EQ(b->getVoxels()->getFileName(), "a scan.raw.2,3,4,uint8");
    EXPECT_EQ(b->getVoxels()->getFileOptions(), "spacing=1,2,0.5 range=5,200");
    EXPECT_EQ(b->getVoxels()->getSpacing(), osg::Vec3d(1.0, 2.0, 0.5));
    EXPECT_EQ(b->getVoxels()->getRange(), osg::Vec2d(5.0, 200.0));
    const auto block = b->getVoxels()->getBrick(0);
    ASSERT_TRUE(block);
    EXPECT_EQ(std::memcmp(block.data, samples.data(), samples.size()), 0);

    a->getVoxels()->setFileName("missing.raw.2,3,4,uint8");
    const auto c = roundTrip(*a);
    ASSERT_TRUE(c && c->getVoxels());
    EXPECT_FALSE(c->getVoxels()->valid());
    EXPECT_EQ(c->getVoxels()->getFileName(), "missing.raw.2,3,4,uint8");
    EXPECT_NE(errors().find("missing.raw"), std::string::npos) << errors();
}

// osgconv reads a scene here and writes it there: what the scene refers to is found from there too.
TEST_P(SerializerTest, ReferencesReachFilesFromAnotherFolder)
{
    namespace fs = std::filesystem;
    writeFile("v.raw", std::string(24, 'x'));
    writeFile("t.lut", "0 1 0 0 0\n9 0 1 0 0.5\n");
    const std::string other = std::string("below/deeper/scene.") + GetParam();
    fs::create_directories(path("below/deeper"));
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(path(""));
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    const auto voxels = readVoxels("v.raw.2,3,4,uint8", options.get());
    const auto table = readLookupTable("t.lut", options.get());
    ASSERT_TRUE(voxels.ok() && table.ok());
    a->setVoxels(voxels->get());
    a->setLookupTable(table->get());
    const auto reads = [&](const osg::Object& object, const std::string& file) {
        EXPECT_TRUE(osgDB::writeObjectFile(object, path(file)));
        osg::ref_ptr<osg::Object> read = osgDB::readRefObjectFile(path(file));
        auto* appearance = dynamic_cast<VolumeAppearance*>(read.get());
        EXPECT_TRUE(appearance && appearance->getVoxels()) << file;
        if (appearance && appearance->getVoxels()) {
            EXPECT_TRUE(appearance->getVoxels()->valid()) << file;
            EXPECT_EQ(appearance->getLookupTable()->getFunction()->points().size(), 2u) << file;
        }
        return osg::ref_ptr<VolumeAppearance>(appearance);
    };
    const auto there = reads(*a, other);
    EXPECT_EQ(there->getVoxels()->getFileName(), "../../v.raw.2,3,4,uint8");
    EXPECT_EQ(there->getLookupTable()->getFileName(), "../../t.lut");
    // And back again; beside its files a scene names them as before.
    const auto back = reads(*there, std::string("back.") + GetParam());
    EXPECT_EQ(back->getVoxels()->getFileName(), "v.raw.2,3,4,uint8");
    EXPECT_EQ(reads(*a, std::string("here.") + GetParam())->getVoxels()->getFileName(),
              "v.raw.2,3,4,uint8");
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, ScenesHoldAllOfThemselvesOnDemand)
{
    std::string samples;
    for (int i = 0; i < 24; ++i)
        samples += static_cast<char>(10 * i);
    writeFile("v.raw", samples);
    writeFile("t.lut", "0 1 0 0 0\n9 0 1 0 0.5\n");
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    const auto voxels = readVoxels(path("v.raw.2,3,4,uint8"));
    const auto table = readLookupTable(path("t.lut"));
    ASSERT_TRUE(voxels.ok() && table.ok());
    a->setVoxels(voxels->get());
    a->setLookupTable(table->get());
    for (const char* hint : {"IncludeData", "IncludeFile"}) {
        osg::ref_ptr<osgDB::Options> options =
            new osgDB::Options(std::string("WriteImageHint=") + hint);
        ASSERT_TRUE(osgDB::writeObjectFile(*a, scene(), options.get()));
        std::filesystem::rename(path("v.raw"), path("gone.raw"));
        std::filesystem::rename(path("t.lut"), path("gone.lut"));
        osg::ref_ptr<osg::Object> read = osgDB::readRefObjectFile(scene());
        std::filesystem::rename(path("gone.raw"), path("v.raw"));
        std::filesystem::rename(path("gone.lut"), path("t.lut"));
        auto* b = dynamic_cast<VolumeAppearance*>(read.get());
        ASSERT_TRUE(b && b->getVoxels() && b->getVoxels()->valid()) << hint << errors();
        EXPECT_EQ(b->getVoxels()->getFileName(), "");
        const auto* source = dynamic_cast<const MemoryVoxelSource*>(b->getVoxels()->getSource());
        ASSERT_TRUE(source && source->sizeInBytes() == samples.size());
        EXPECT_EQ(std::memcmp(source->data(), samples.data(), samples.size()), 0);
        EXPECT_EQ(b->getLookupTable()->getFunction()->points().size(), 2u);
    }
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, CutsKeepTheirRegions)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance, b = new VolumeAppearance;
    osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    a->setCut(cut);
    b->setCut(cut); // shared
    a->addChild(b);
    core::TriangleMesh mesh;
    mesh.vertices = {{0.1, 0, 0}, {1, 0, 0}, {0, 1.0 / 3.0, 0}, {0, 0, 1}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const osg::ref_ptr<Voxels> mask = makeVoxels(VoxelType::UINT8, 1, {3, 4, 5});
    for (const CutRegion& region :
         {CutRegion::halfSpace({1.0 / 3.0, 0, 2, -0.1}),
          CutRegion::mask(mask, 2.5, std::numeric_limits<double>::infinity()).complement(),
          CutRegion::box({0, 1, 2, 3.3, 4, 5}).complement(),
          CutRegion::sphere({0.1, 0.2, 0.3}, 6.4e6), CutRegion::surface(mesh)})
        ASSERT_TRUE(cut->addRegion(region));
    ASSERT_TRUE(cut->setSoftness(0.7));
    ASSERT_TRUE(cut->setResolution(99));
    const auto copy = roundTrip(*a);
    ASSERT_TRUE(copy && copy->getCut()) << errors();
    const auto* below = dynamic_cast<VolumeAppearance*>(copy->getChild(0));
    EXPECT_EQ(below->getCut(), copy->getCut());
    const VolumeCut& read = *copy->getCut();
    EXPECT_EQ(read.getSoftness(), 0.7);
    EXPECT_EQ(read.getResolution(), 99);
    ASSERT_EQ(read.getNumRegions(), 5u);
    EXPECT_EQ(read.getRegion(0).getPlane(), osg::Vec4d(1.0 / 3.0, 0, 2, -0.1));
    EXPECT_EQ(read.getRegion(1).getBox()._max, osg::Vec3d(3.3, 4, 5));
    EXPECT_TRUE(read.getRegion(1).isComplement());
    EXPECT_EQ(read.getRegion(2).getRadius(), 6.4e6);
    EXPECT_EQ(read.getRegion(2).getCenter(), osg::Vec3d(0.1, 0.2, 0.3));
    EXPECT_EQ(read.getRegion(3).getMesh()->vertices, mesh.vertices);
    EXPECT_EQ(read.getRegion(3).getMesh()->indices, mesh.indices);
    EXPECT_FALSE(read.getRegion(3).isComplement());
    const CutRegion& last = read.getRegion(4); // masks come last
    EXPECT_EQ(last.getKind(), CutRegion::MASK);
    EXPECT_TRUE(last.isComplement());
    EXPECT_EQ(last.getMaskLow(), 2.5);
    EXPECT_EQ(last.getMaskHigh(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(last.getMask()->getSize(), osg::Vec3i(3, 4, 5));
    EXPECT_TRUE(errors().empty()) << errors();
}

TEST_P(SerializerTest, WritingTwiceGivesTheSameFile)
{
    osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    a->setVoxels(makeVoxels(VoxelType::FLOAT32, 1, {6, 5, 4}));
    a->addChild(VolumeGeometry::createBox(*a->getVoxels()));
    const std::string first = write(*a);
    const auto copy = roundTrip(*a);
    ASSERT_TRUE(copy);
    EXPECT_EQ(write(*copy), first);
}

INSTANTIATE_TEST_SUITE_P(Formats, SerializerTest, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& p) { return std::string(p.param); });

} // namespace SerializerTests
