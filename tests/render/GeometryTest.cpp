// Whatever tetrahedra fill a region, and whatever voxels their corners refer to.

#include "Volumes.h"

#include <osgVolumizer/VolumeSolids.h>
#include <support/GLTest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace GeometryTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using Tetra = std::array<int, 4>;

// The box as five tetrahedra, on corners numbered as in core::Box3d.
const std::array<Tetra, 5> FIVE = {
    {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}}};

RenderOptions view(bool perspective = true)
{
    RenderOptions options;
    options.size(80, 80).lookAt({44, -20, 36}, {12, 10, 8}, {0, 0, 1});
    if (perspective)
        options.perspective(45.0);
    else
        options.orthographic(19.0);
    return options;
}

// Corners of tetrahedra, each with what a vertex record holds before its position.
struct Corner
{
    glm::dvec3 position;
    std::vector<double> fields;
};

osg::ref_ptr<VolumeGeometry> makeGeometry(const core::VertexFormat& format,
                                          const std::vector<Corner>& corners)
{
    core::TetraSet set;
    set.vertices = core::VertexArray(format);
    set.vertices.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::copy(corners[i].fields.begin(), corners[i].fields.end(), set.vertices.record(i));
        set.vertices.setPosition(i, corners[i].position);
    }
    for (const Tetra& t : FIVE)
        set.indices.insert(set.indices.end(), t.begin(), t.end());
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    EXPECT_TRUE(geometry->setTetraSet(std::move(set)));
    return geometry;
}

// A box of 25 x 21 x 17 voxels whose corners lie where `place` puts them.
class Geometry : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels({25, 21, 17}, bumps);
        ASSERT_TRUE(_voxels->setBrickSize({13, 13, 13}));
        _twin = makeTwin(_voxels, smoothPoints(0.05));
        _extent = _voxels->getLayout().extent();
    }

    // Sets explicit voxel coordinates, in both twins.
    oracle::Scene deform(const std::function<glm::dvec3(const glm::dvec3&)>& place)
    {
        std::vector<Corner> corners;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 voxel = _extent.corner(i);
            corners.push_back({place(voxel), {voxel.x, voxel.y, voxel.z}});
        }
        _twin.node->setChild(0, makeGeometry(core::VertexLayout::T3F_V3F, corners));
        oracle::Scene scene;
        for (const Tetra& t : FIVE) {
            std::array<glm::dvec3, 4> object, voxel;
            for (int i = 0; i < 4; ++i) {
                object[i] = corners[t[i]].position;
                voxel[i] = _extent.corner(t[i]);
            }
            oracle::Volume volume = _twin.oracle;
            volume.region = oracle::tetraRegion(object);
            volume.objectToField = oracle::tetraMap(object, voxel);
            scene.volumes.push_back(volume);
        }
        return scene;
    }

    void expectOracle(const oracle::Scene& scene, const std::string& name)
    {
        for (const bool perspective : {true, false}) {
            const FloatImage image = support::renderScene(_twin.node, view(perspective));
            const FloatImage expected = oraclePicture(scene, view(perspective));
            support::savePicture(image, "geometry_" + name);
            support::savePicture(expected, "geometry_" + name + "_oracle");
            EXPECT_GT(support::coveredPixels(expected, 0.1f).count(), 250u);
            EXPECT_LE(compare(image, expected).rmse, 2e-3)
                << name << (perspective ? ", perspective" : ", orthographic");
        }
    }

    osg::ref_ptr<Voxels> _voxels;
    TwinVolume _twin;
    core::Box3d _extent;
};

TEST_F(Geometry, FiveTwentyFourAndEnclosingTetrahedraShowTheSameBox)
{
    const osg::BoundingBoxd box(0, 0, 0, 24, 20, 16);
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        _twin.node->setTechnique(technique);
        // Slices between fixed planes: an enclosing tetrahedron reaches over other depths.
        _twin.node->setSamplingSpace(SamplingSpace::VIEW_VOLUME);
        RenderOptions options = view();
        options.computeNearFar = false;
        options.projection.makePerspective(45.0, 1.0, 5.0, 120.0);
        const FloatImage expected = support::renderScene(_twin.node, options);
        EXPECT_GT(support::coveredPixels(expected, 0.1f).count(), 1000u);
        for (const auto tessellation :
             {VolumeGeometry::FIVE, VolumeGeometry::TWENTY_FOUR, VolumeGeometry::ENCLOSING}) {
            _twin.node->setChild(0, VolumeGeometry::createBox(box, tessellation));
            const FloatImage image = support::renderScene(_twin.node, options);
            support::savePicture(image, "geometry_tessellation" + std::to_string(tessellation));
            EXPECT_LT(compare(image, expected).maximum, 1e-4) << technique << " " << tessellation;
        }
    }
}

TEST_F(Geometry, PartOfTheBox)
{
    // A tetrahedron, in either orientation, and one that reaches beyond the voxels.
    const std::array<glm::dvec3, 4> inside = {
        glm::dvec3(2, 2, 1), {23, 4, 3}, {6, 19, 2}, {9, 8, 15}};
    const std::array<glm::dvec3, 4> beyond = {
        glm::dvec3(-6, 3, 2), {30, 5, 4}, {8, 30, 6}, {9, 8, 28}};
    for (const auto& corners : {inside, beyond})
        for (const bool inverted : {false, true})
            for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
                core::TetraSet set;
                set.vertices.resize(4);
                for (std::size_t i = 0; i < 4; ++i)
                    set.vertices.setPosition(i, corners[i]);
                set.indices = {0, 1, 2, 3};
                if (inverted) std::swap(set.indices[1], set.indices[2]);
                osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
                ASSERT_TRUE(geometry->setTetraSet(std::move(set)));
                _twin.node->setChild(0, geometry);
                _twin.node->setTechnique(technique);
                _twin.setPeriod(0.25);
                oracle::Volume volume = _twin.oracle;
                for (const core::Plane& plane : oracle::tetraRegion(corners))
                    volume.region.push_back(plane);
                expectOracle(oracleScene(volume), "part");
            }
}

TEST_F(Geometry, ConcaveSetsAreFilledOnce)
{
    // Two tetrahedra of the five: not convex together, so drawn as slices by default.
    const std::shared_ptr<const core::TetraSet> five =
        VolumeGeometry::createBox(*_voxels)->getTetraSet();
    core::TetraSet two = *five;
    two.indices = {0, 1, 2, 4, 3, 2, 1, 7};
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    ASSERT_TRUE(geometry->setTetraSet(two));
    _twin.node->setChild(0, geometry);
    _twin.setPeriod(0.25);
    oracle::Scene scene;
    for (const Tetra& t : {FIVE[0], FIVE[1]}) {
        oracle::Volume volume = _twin.oracle;
        volume.region = oracle::tetraRegion({_extent.corner(t[0]), _extent.corner(t[1]),
                                             _extent.corner(t[2]), _extent.corner(t[3])});
        scene.volumes.push_back(volume);
    }
    expectOracle(scene, "concave");
}

TEST_F(Geometry, ABoxWithAHoleIsTheBoxAroundIt)
{
    // Along the hole: each ray meets either as much of the voxels as in the whole box, or nothing.
    const double radius = 6.0, half = 12.0;
    const osg::Vec3d center(12, 10, 8);
    const GeometryResult drilled =
        createBoxMinusCylinder(osg::BoundingBoxd(0, 0, 0, 24, 20, 16), center, 2, radius, 16, 2);
    ASSERT_TRUE(drilled.ok()) << drilled.status.text;
    _twin.node->setTechnique(VolumeAppearance::SLICES);
    RenderOptions options;
    options.size(80, 80).lookAt({12, 10, 60}, center, {0, 1, 0}).orthographic(half);
    const FloatImage box = support::renderScene(_twin.node, options);
    _twin.node->setChild(0, *drilled);
    const FloatImage image = support::renderScene(_twin.node, options);
    support::savePicture(image, "geometry_hole");
    double difference = 0.0, inside = 0.0, least = 1.0;
    const double pixel = 2.0 * half / 80.0;
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x) {
            const double distance = std::hypot((x - 39.5) * pixel, (y - 39.5) * pixel);
            if (distance < 0.99 * radius - pixel) {
                inside = std::max(inside, double(image.at(x, y).a));
                least = std::min(least, double(box.at(x, y).a));
            } else if (distance > radius + pixel) {
                const glm::vec4 d = glm::abs(image.at(x, y) - box.at(x, y));
                difference = std::max(difference, double(std::max({d.r, d.g, d.b, d.a})));
            }
        }
    EXPECT_EQ(inside, 0.0);
    EXPECT_GT(least, 0.05); // of the box there
    EXPECT_LT(difference, 1e-5);
}

TEST_F(Geometry, AffineVoxelCoordinates)
{
    // Flipped along x, turned, moved and stretched: one affine map, so slabs.
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        _twin.node->setTechnique(technique);
        _twin.setPeriod(0.25);
        const oracle::Scene scene = deform([](const glm::dvec3& v) {
            return glm::dvec3(26.0 - 1.1 * v.x + 0.2 * v.y, 0.9 * v.y - 0.1 * v.z + 1.0,
                              1.3 * v.z + 0.15 * v.x - 4.0);
        });
        expectOracle(scene,
                     technique == VolumeAppearance::SLABS ? "affine_slabs" : "affine_slices");
    }
}

TEST_F(Geometry, DeformedBox)
{
    _twin.setPeriod(0.25);
    const oracle::Scene scene = deform([](const glm::dvec3& v) {
        // Twisted about z, and narrower at the top.
        const double f = v.z / 16.0, narrow = 1.0 - 0.4 * f;
        const glm::dvec3 p = v - glm::dvec3(12.0, 10.0, 0.0);
        return glm::dvec3(12.0 + narrow * (p.x - 0.3 * f * p.y),
                          10.0 + narrow * (p.y + 0.3 * f * p.x), v.z + 0.1 * p.x);
    });
    expectOracle(scene, "deformed");
}

// A straight colour that is one linear function of position.
glm::dvec4 linearColor(const glm::dvec3& p)
{
    const double f = (p.x + 0.5 * p.y + 0.8 * p.z) / 46.8;
    return glm::mix(glm::dvec4(0.1, 0.3, 1.0, 0.01), glm::dvec4(1.0, 0.5, 0.0, 0.05), f);
}

TEST_F(Geometry, ColoursOfVerticesWithoutVoxels)
{
    std::vector<Corner> corners;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p = _extent.corner(i);
        const glm::dvec4 c = linearColor(p);
        corners.push_back({p, {c.r, c.g, c.b, c.a}});
    }
    _twin.node->setChild(0, makeGeometry(core::VertexLayout::C4F_V3F, corners));
    _twin.node->setVoxels(nullptr);
    _twin.setPeriod(0.25);
    oracle::Volume volume = oracle::boxVolume(
        std::make_shared<oracle::RampField>(glm::dvec3(1.0, 0.5, 0.8) / 46.8, 0.0), _extent,
        oracle::Table({{0.0, linearColor({0, 0, 0})}, {1.0, linearColor({24, 20, 16})}}));
    expectOracle(oracleScene(volume), "colours");
}

TEST_F(Geometry, ColoursOfVerticesModulateVoxels)
{
    // Half the extinction, and colours without green.
    std::vector<Corner> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({_extent.corner(i), {1.0, 0.0, 0.5, 0.5}});
    _twin.node->setChild(0, makeGeometry(core::VertexLayout::C4F_V3F, corners));
    _twin.setPeriod(0.25);
    Points points = smoothPoints(0.05);
    for (auto& point : points)
        point.color *= glm::dvec4(1.0, 0.0, 0.5, 1.0);
    oracle::Volume volume = _twin.oracle;
    volume.table = oracle::Table(points);
    volume.unit *= 2.0;
    expectOracle(oracleScene(volume), "modulated");
}

} // namespace

} // namespace GeometryTest
