// Unstructured grids: scalars of vertices and of tetrahedra against the light of each cell in double precision, whatever
// the mesh looks like.
#include "Volumes.h"

#include <oracles/MeshOracle.h>
#include <oracles/TestMeshes.h>
#include <support/GLTest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace MeshTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

/// A field of one bump with some detail, 0 to 1 in the unit cube.
class Bump : public oracle::Field
{
public:
    double value(const glm::dvec3& p) const override
    {
        const glm::dvec3 d = p - glm::dvec3(0.45, 0.55, 0.5);
        return 0.8 * std::exp(-6.0 * glm::dot(d, d)) + 0.1 * std::sin(5.0 * p.x) * std::cos(4.0 * p.z);
    }
    glm::dvec3 gradient(const glm::dvec3&) const override { return glm::dvec3(0.0); }
};

Points colorfulPoints()
{
    return {{0.0, {0.1, 0.2, 0.9, 0.0}},
            {0.3, {0.9, 0.3, 0.1, 0.05}},
            {0.5, {0.2, 0.9, 0.3, 0.6}},
            {0.5, {0.9, 0.9, 0.1, 0.1}},
            {1.0, {1.0, 0.5, 0.8, 0.7}}};
}

struct TwinMesh
{
    osg::ref_ptr<VolumeAppearance> node;
    osg::ref_ptr<VolumeGeometry> geometry;
    std::shared_ptr<oracle::MeshOracle> oracle;
};

TwinMesh makeTwin(const oracle::TetraMesh& mesh, const Points& points, double unit)
{
    TwinMesh twin;
    twin.geometry = new VolumeGeometry;
    EXPECT_TRUE(twin.geometry->setTetraSet(oracle::tetraSet(mesh)).ok());
    std::vector<float> scalars(mesh.scalars.begin(), mesh.scalars.end());
    EXPECT_TRUE(twin.geometry
                    ->setScalars(scalars, mesh.scalarsPerCell ? VolumeGeometry::PER_TETRAHEDRON
                                                              : VolumeGeometry::PER_VERTEX)
                    .ok());
    EXPECT_TRUE(twin.geometry->setScalarRange(osg::Vec2d(-0.1, 0.9)).ok());
    twin.node = new VolumeAppearance;
    twin.node->setLookupTable(makeTable(points));
    twin.node->setOpacityUnit(unit);
    twin.node->addChild(twin.geometry);
    twin.oracle = std::make_shared<oracle::MeshOracle>(
        mesh, oracle::Table(points, glm::dvec2(-0.1, 0.9)), unit);
    return twin;
}

support::RenderOptions viewFrom(const osg::Vec3d& direction, const osg::BoundingSphere& bound,
                                bool orthographic = false)
{
    support::RenderOptions options;
    options.size(128, 128);
    const osg::Vec3d center = bound.center();
    options.lookAt(center + direction * bound.radius(), center, osg::Vec3d(0.1, 0.2, 1.0));
    if (orthographic)
        options.orthographic(1.05 * bound.radius());
    else
        options.perspective(30.0);
    return options;
}

} // namespace

class MeshTest : public support::GLTest
{
};

TEST_F(MeshTest, IsAsExactAsFloats)
{
    for (const int n : {3, 12}) {
        oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(n));
        oracle::jitter(mesh, 0.2 / n, 7);
        oracle::sampleField(mesh, Bump());
        const TwinMesh twin = makeTwin(mesh, colorfulPoints(), 0.1);
        for (const bool orthographic : {false, true}) {
            const auto options = viewFrom({3.1, 2.2, 1.3}, twin.node->getBound(), orthographic);
            const support::FloatImage picture = support::renderScene(twin.node, options);
            const support::FloatImage expected =
                oracle::render(*twin.oracle, support::oracleCamera(options));
            const support::Difference d = support::compare(picture, expected);
            support::savePicture(picture, "mesh" + std::to_string(n));
            support::savePicture(expected, "meshoracle" + std::to_string(n));
            std::printf("n %d ortho %d rmse %g max %g at %d %d bias %g pixels %zu\n", n, orthographic, d.rmse,
                        d.maximum, d.worstX, d.worstY, d.bias, d.pixels);
            EXPECT_LT(d.rmse, 1e-5);
        }
    }
}

} // namespace MeshTest
