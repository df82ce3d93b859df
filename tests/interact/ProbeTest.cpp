#include "PickOracle.h"

#include <osgVolumizer/interact/Probe.h>

#include <osg/MatrixTransform>

namespace ProbeTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int SIZE = 20;
const Points POINTS = {{0.0, {0.1, 0.2, 0.9, 0.1}}, {1.0, {1.0, 0.5, 0.1, 0.4}}};

osg::ref_ptr<VolumeAppearance> volume()
{
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    appearance->setLookupTable(makeTable(POINTS));
    return appearance;
}

TEST(Probe, ListsVoxelsInOrder)
{
    const auto appearance = volume();
    const auto grid = gridOf(*appearance->getVoxels());
    const oracle::Table table(POINTS);
    RandomLines lines(glm::dvec3(0.0), glm::dvec3(SIZE - 1));
    for (int i = 0; i < 100; ++i) {
        const Line line = lines.next();
        const auto found =
            probe(geometryBelow(*appearance), *appearance, toVec3d(line.start), toVec3d(line.end));
        ASSERT_TRUE(found.ok()) << found.status.text;
        double length = 0.0, last = 0.0, depth = 0.0;
        for (const ProbedVoxel& voxel : found->voxels) {
            const glm::dvec3 p = toDvec3(voxel.object);
            const osg::Vec3i& n = voxel.index;
            for (int a = 0; a < 3; ++a)
                EXPECT_LE(std::fabs(p[a] - n[a]), 0.5 + 1e-6);
            EXPECT_FLOAT_EQ(voxel.raw, grid->sample(n.x(), n.y(), n.z()));
            EXPECT_NEAR(voxel.filtered, grid->value(p), 1e-9);
            const glm::dvec4 color = table.color(grid->value(p));
            EXPECT_NEAR(voxel.color.r(), color.r, 1e-9);
            EXPECT_NEAR(voxel.color.a(), color.a, 1e-9);
            EXPECT_GT(voxel.distance, last);
            EXPECT_NEAR(voxel.distance, glm::length(p - line.start), 1e-9);
            last = voxel.distance;
            length += voxel.length;
            depth += 0.5 * voxel.length * oracle::Table::extinction(color.a);
            EXPECT_NEAR(voxel.transmittance, std::exp(-depth), 0.01);
            depth += 0.5 * voxel.length * oracle::Table::extinction(color.a);
        }
        const Line& l = line;
        int samples = 0;
        for (int k = 0; k < 10000; ++k)
            samples += inside(l.at((k + 0.5) / 10000), glm::dvec3(0.0), glm::dvec3(SIZE - 1));
        EXPECT_NEAR(length, samples * l.length() / 10000, 0.02);
    }
}

TEST(Probe, StaysInOneBrick)
{
    const auto appearance = volume();
    ASSERT_TRUE(appearance->getVoxels()->setBrickSize({10, 10, 10}).ok());
    ProbeOptions options;
    std::size_t all = 0;
    const osg::Vec3d start(3, 4, -10), end(3, 4, 30);
    for (options.brick = 0; options.brick < appearance->getVoxels()->getLayout().brickCount();
         ++options.brick) {
        const auto found = probe(geometryBelow(*appearance), *appearance, start, end, options);
        ASSERT_TRUE(found.ok());
        all += found->voxels.size();
    }
    options.brick = -1;
    const auto whole = probe(geometryBelow(*appearance), *appearance, start, end, options);
    EXPECT_EQ(whole->voxels.size(), std::size_t(SIZE));
    EXPECT_GE(all, whole->voxels.size()); // a voxel that is cut counts in both bricks
    EXPECT_LE(all, whole->voxels.size() + 2);
    options.brick = 1000;
    EXPECT_EQ(probe(geometryBelow(*appearance), *appearance, start, end, options).status.code,
              ErrorCode::INDEX_OUT_OF_RANGE);
}

TEST(Probe, KnowsTheWorld)
{
    const auto appearance = volume();
    osg::ref_ptr<osg::MatrixTransform> root = new osg::MatrixTransform(
        osg::Matrixd::scale(0.5, 0.5, 0.5) * osg::Matrixd::translate(1000, 0, 0));
    root->addChild(appearance);
    const osg::NodePath path{root, appearance, appearance->getChild(0)};
    const auto found = probe(path, {1002.5, 3, -90}, {1002.5, 3, 90});
    ASSERT_TRUE(found.ok()) << found.status.text;
    ASSERT_EQ(found->voxels.size(), std::size_t(SIZE));
    EXPECT_NEAR(found->voxels[4].world.x(), 1002.5, 1e-9);
    EXPECT_NEAR(found->voxels[4].world.z(), 2.0, 1e-9);
    EXPECT_NEAR(found->voxels[4].object.z(), 4.0, 1e-9);
    EXPECT_EQ(found->voxels[4].index, osg::Vec3i(5, 6, 4));
    root->setMatrix(osg::Matrixd::scale(0, 0, 0));
    EXPECT_EQ(probe(path, {0, 0, 0}, {1, 1, 1}).status.code, ErrorCode::SINGULAR_MATRIX);
    EXPECT_EQ(probe(osg::NodePath(), {0, 0, 0}, {1, 1, 1}).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(probe(osg::NodePath{appearance->getChild(0)}, {0, 0, 0}, {1, 1, 1}).status.code,
              ErrorCode::VALUE_INVALID);
}

TEST(Probe, RefusesWhatItCannotLookAt)
{
    const auto appearance = volume();
    const VolumeGeometry& geometry = geometryBelow(*appearance);
    EXPECT_EQ(probe(geometry, *appearance, {1, 1, 1}, {1, 1, 1}).status.code,
              ErrorCode::VALUE_INVALID);
    const osg::ref_ptr<VolumeAppearance> empty = new VolumeAppearance;
    EXPECT_EQ(probe(geometry, *empty, {1, 1, 1}, {2, 1, 1}).status.code, ErrorCode::VALUE_INVALID);
    const osg::ref_ptr<VolumeGeometry> none = new VolumeGeometry;
    EXPECT_TRUE(probe(*none, *appearance, {1, 1, 1}, {2, 1, 1})->voxels.empty());
}

TEST(CrossedFaces, EnterAndLeave)
{
    const auto box =
        VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 4, 4, 4), VolumeGeometry::TWENTY_FOUR);
    RandomLines lines(glm::dvec3(0.0), glm::dvec3(4.0));
    for (int i = 0; i < 1000; ++i) {
        // Lines through corners, edges and the middle of faces too.
        Line line = lines.next();
        if (i % 2) line = {glm::round(line.start), glm::round(line.end)};
        const auto faces = crossedFaces(*box, toVec3d(line.start), toVec3d(line.end));
        ASSERT_TRUE(faces.ok());
        ASSERT_TRUE(faces->empty() || faces->size() == 2) << i << ": " << faces->size();
        if (faces->empty()) {
            EXPECT_TRUE(i % 2 == 1) << "no line passes beside the box";
            continue;
        }
        EXPECT_TRUE((*faces)[0].enters);
        EXPECT_FALSE((*faces)[1].enters);
        EXPECT_LE((*faces)[0].ratio, (*faces)[1].ratio);
        for (const CrossedFace& face : *faces) {
            double off = 1e9;
            for (int a = 0; a < 3; ++a)
                off = std::min({off, std::fabs(face.point[a]), std::fabs(face.point[a] - 4.0)});
            EXPECT_LT(off, 1e-9);
        }
    }
}

TEST(CrossedFaces, TellPartsApart)
{
    core::TetraSet set;
    set.vertices.resize(8);
    for (int part = 0; part < 2; ++part) {
        const double z = 5.0 * part;
        const glm::dvec3 corners[] = {{0, 0, z}, {4, 0, z}, {0, 4, z}, {0, 0, z + 2}};
        for (std::size_t i = 0; i < 4; ++i) {
            set.vertices.setPosition(4 * std::size_t(part) + i, corners[i]);
            set.indices.push_back(4 * unsigned(part) + unsigned(i));
        }
    }
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    ASSERT_TRUE(geometry->setTetraSet(set).ok());
    const auto faces = crossedFaces(*geometry, {1, 1, 20}, {1, 1, -20});
    ASSERT_TRUE(faces.ok());
    ASSERT_EQ(faces->size(), 4u);
    const unsigned parts[] = {1, 1, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ((*faces)[i].tetrahedron, parts[i]);
        EXPECT_EQ((*faces)[i].enters, i % 2 == 0);
    }
    EXPECT_NEAR((*faces)[0].point.z(), 6.0, 1e-12);
    EXPECT_EQ(crossedFaces(*geometry, {1, 1, 1}, {1, 1, 1}).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_TRUE(
        crossedFaces(*osg::ref_ptr<VolumeGeometry>(new VolumeGeometry), {1, 1, 1}, {2, 1, 1})
            ->empty());
}

} // namespace

} // namespace ProbeTest
