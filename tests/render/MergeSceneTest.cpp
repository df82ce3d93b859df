// Mixed scenes against the double-precision oracle: how far off a picture is at period 1, and how
// fast the error falls with the period.

#include "MixedScene.h"

#include <oracles/TestMeshes.h>
#include <support/GLTest.h>
#include <support/Precision.h>

#include <osgParticle/ParticleSystem>

#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace MergeSceneTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const glm::dvec3 MIDDLE(0.5 * (SIZE - 1));

const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.005}}, {1.0, {1.0, 0.4, 0.1, 0.08}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.002}}, {1.0, {0.2, 0.2, 1.0, 0.1}}};
const Points GREY = {{0.0, {0.8, 0.8, 0.8, 0.0}}, {1.0, {0.9, 0.9, 0.2, 0.15}}};
const glm::dvec4 GREEN(0.1, 0.9, 0.2, 0.6), RED(0.9, 0.1, 0.2, 0.4), BLUE(0.2, 0.3, 1.0, 0.5);

osg::ref_ptr<Voxels> blob()
{
    return makeBlob(glm::ivec3(SIZE), 5.5);
}
osg::ref_ptr<Voxels> bumpy()
{
    return makeVoxels(glm::ivec3(SIZE), bumps);
}

/// Turned about the middle of the voxels, then moved.
osg::Matrixd turned(double degrees, const osg::Vec3d& axis, const osg::Vec3d& move = osg::Vec3d())
{
    const osg::Vec3d middle(MIDDLE.x, MIDDLE.y, MIDDLE.z);
    return osg::Matrixd::translate(-middle) *
           osg::Matrixd::rotate(osg::DegreesToRadians(degrees), axis) *
           osg::Matrixd::translate(middle + move);
}

RenderOptions perspectiveView()
{
    RenderOptions options;
    options.size(128, 128).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    return options;
}

struct Scene
{
    const char* name;
    void (*build)(MixedScene&, RenderOptions&);
    double order;          // that the error falls with, at least
    double coarsest = 4.0; // period
    double error = 4e-3;   // at a period of 1
};

void addSlantedPlane(MixedScene& scene)
{
    scene.addQuad({glm::vec3(-5, -3, 2), {37, 0, 6}, {40, 36, 30}, {-4, 30, 25}}, GREEN);
}

void slantedPlane(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(blob(), WARM);
    addSlantedPlane(scene);
}

void crossingPlanes(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(bumpy(), WARM);
    scene.addQuad({glm::vec3(-4, 16, -4), {36, 16, -4}, {36, 16, 36}, {-4, 16, 36}}, GREEN);
    scene.addQuad({glm::vec3(16, -4, -4), {16, 36, -4}, {16, 36, 36}, {16, -4, 36}}, RED);
    scene.addQuad({glm::vec3(-4, -4, 14), {36, -4, 19}, {36, 36, 19}, {-4, 36, 14}}, BLUE);
}

void nestedSpheres(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(blob(), WARM);
    scene.addMesh(sphereMesh(MIDDLE, 6.0, 24, 12), GREEN);
    scene.addMesh(sphereMesh(MIDDLE, 11.0, 24, 12), RED);
    scene.addMesh(sphereMesh(MIDDLE, 24.0, 24, 12), {0.2, 0.3, 1.0, 0.2}); // all around
}

void thinRods(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(bumpy(), WARM);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-2.0, 34.0);
    const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    for (int i = 0; i < 12; ++i) {
        const glm::dvec3 from = point(), to = point();
        scene.addMesh(rodMesh(from, to, 0.4, 6),
                      {0.1 + 0.07 * i, 0.9 - 0.07 * i, 0.3 + 0.05 * (i % 4), 0.5});
    }
}

// Quads that face the eye: a particle system that stands still.
void particles(MixedScene& scene, RenderOptions& options)
{
    scene.addVolume(blob(), WARM);
    osg::ref_ptr<osgParticle::ParticleSystem> system = new osgParticle::ParticleSystem;
    system->setDefaultAttributes("", false, false);
    system->getStateSet()->setAttributeAndModes(
        new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA));
    system->setParticleAlignment(osgParticle::ParticleSystem::BILLBOARD);
    osgParticle::Particle seed;
    seed.setShape(osgParticle::Particle::QUAD);
    seed.setLifeTime(0.0);
    const float size = 2.0f;
    seed.setSizeRange(osgParticle::rangef(size, size));
    seed.setColorRange(
        osgParticle::rangev4(osg::Vec4(1, 0.8f, 0.2f, 1), osg::Vec4(1, 0.8f, 0.2f, 1)));
    seed.setAlphaRange(osgParticle::rangef(0.5f, 0.5f));
    const osg::Matrixd toWorld = osg::Matrixd::inverse(options.view);
    const osg::Vec3d right = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), toWorld);
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), toWorld);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-2.0f, 34.0f);
    for (int i = 0; i < 60; ++i) {
        const osg::Vec3 p(place(random), place(random), place(random));
        osgParticle::Particle* particle = system->createParticle(&seed);
        particle->setPosition(p);
        particle->update(0.0, false);
        const auto corner = [&](double x, double y) {
            const osg::Vec3d c = osg::Vec3d(p) + (right * x + up * y) * size;
            return glm::vec3(c.x(), c.y(), c.z());
        };
        scene.addTruth(quadMesh({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}),
                       {1.0, 0.8, 0.2, 0.5});
    }
    system->setInitialBound(osg::BoundingBox(-6, -6, -6, 38, 38, 38));
    scene.root()->addChild(system);
}

void twoVolumes(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(blob(), WARM);
    scene.addVolume(bumpy(), COLD, turned(35.0, {0.3, 1.0, 0.5}, {9, 4, 6}));
}

void threeVolumes(MixedScene& scene, RenderOptions& options)
{
    twoVolumes(scene, options);
    scene.addVolume(blob(), GREY,
                    osg::Matrixd::scale(1.3, 1.3, 1.3) *
                        turned(-50.0, {1.0, 0.2, 0.7}, {-4, 2, -6}));
}

void twoVolumesAndPlane(MixedScene& scene, RenderOptions& options)
{
    twoVolumes(scene, options);
    addSlantedPlane(scene);
}

// The caller adds its truth.
void adoptMesh(MixedScene& scene, const oracle::TetraMesh& mesh, const Points& points)
{
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    ASSERT_TRUE(geometry->setTetraSet(oracle::tetraSet(mesh)).ok());
    ASSERT_TRUE(geometry->setScalarRange(osg::Vec2d(0.0, 1.0)).ok());
    ASSERT_TRUE(geometry->setScalars({mesh.scalars.begin(), mesh.scalars.end()}).ok());
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setLookupTable(makeTable(points));
    appearance->setOpacityUnit(1.0);
    appearance->addChild(geometry);
    scene.adopt(*appearance);
}

// A jittered lattice of tetrahedra with scalars that are linear in space, so that it shows what a
// box with that field does.
void addTetrahedra(MixedScene& scene, const osg::Vec3d& corner, double size, const Points& points)
{
    const glm::dvec3 low(corner.x(), corner.y(), corner.z());
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(5));
    oracle::jitter(mesh, 0.04, 3);
    oracle::transform(mesh, glm::scale(glm::translate(glm::dmat4(1.0), low), glm::dvec3(size)));
    const auto field = std::make_shared<oracle::RampField>(
        glm::dvec3(0.3, 0.5, -0.2) / size, 0.3 - glm::dot(glm::dvec3(0.3, 0.5, -0.2), low) / size);
    oracle::sampleField(mesh, *field);
    adoptMesh(scene, mesh, points);
    scene.truth().volumes.push_back(
        oracle::boxVolume(field, {low, low + size}, oracle::Table(points)));
}

void meshAndPlane(MixedScene& scene, RenderOptions&)
{
    addTetrahedra(scene, {0, 0, 0}, 32.0, WARM);
    addSlantedPlane(scene);
}

void meshInVolume(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(blob(), COLD);
    addTetrahedra(scene, {6, 10, 4}, 20.0, WARM);
}

// A quarter is missing, so that rays leave it before its bounds end.
void cornerInVolume(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(blob(), COLD);
    oracle::TetraMesh mesh = oracle::cornerMesh(4);
    oracle::transform(
        mesh, glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(6, 5, 7)), glm::dvec3(21.0)));
    const auto field = std::make_shared<oracle::RampField>(glm::dvec3(0.01, 0.02, -0.01), 0.3);
    oracle::sampleField(mesh, *field);
    adoptMesh(scene, mesh, WARM);
    for (const auto& cell : mesh.cells) {
        oracle::Volume part;
        part.region = oracle::tetraRegion({mesh.corner(cell, 0), mesh.corner(cell, 1),
                                           mesh.corner(cell, 2), mesh.corner(cell, 3)});
        part.field = field;
        part.table = oracle::Table(WARM);
        scene.truth().volumes.push_back(part);
    }
}

void meshesAndPlane(MixedScene& scene, RenderOptions&)
{
    addTetrahedra(scene, {0, 0, 0}, 24.0, WARM);
    addTetrahedra(scene, {9, 5, 8}, 22.0, COLD);
    addSlantedPlane(scene);
}

// Eight tetrahedra about a middle point that is pushed aside: no one map to the voxels.
void deformedVolume(MixedScene& scene, RenderOptions&)
{
    const osg::ref_ptr<Voxels> voxels = blob();
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(voxels);
    appearance->setLookupTable(makeTable(WARM));
    const glm::dvec3 directions[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                      {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    std::vector<glm::dvec3> from, to;
    for (const glm::dvec3& d : directions) {
        from.push_back(MIDDLE + 16.0 * d);
        to.push_back(MIDDLE + (18.0 + 3.0 * d.x - 2.0 * d.y) * d + glm::dvec3(1, 2, 0));
    }
    from.push_back(MIDDLE);
    to.push_back(MIDDLE + glm::dvec3(4, -3, 5));
    core::TetraSet set;
    set.vertices = core::VertexArray(core::VertexFormat::user(3, 0, 0));
    set.vertices.resize(7);
    for (unsigned i = 0; i < 7; ++i) {
        set.vertices.setPosition(i, to[i]);
        for (int a = 0; a < 3; ++a)
            set.vertices.record(i)[a] = from[i][a];
    }
    const auto grid = gridOf(*voxels);
    for (std::uint32_t x : {0u, 1u})
        for (std::uint32_t y : {2u, 3u})
            for (std::uint32_t z : {4u, 5u}) {
                set.indices.insert(set.indices.end(), {x, y, z, 6u});
                const std::array<glm::dvec3, 4> corners = {to[x], to[y], to[z], to[6]};
                oracle::Volume part;
                part.region = oracle::tetraRegion(corners);
                part.objectToField =
                    oracle::tetraMap(corners, {from[x], from[y], from[z], from[6]});
                part.field = grid;
                part.table = oracle::Table(WARM);
                scene.truth().volumes.push_back(part);
            }
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    ASSERT_TRUE(geometry->setTetraSet(set).ok());
    appearance->addChild(geometry);
    scene.adopt(*appearance);
    addSlantedPlane(scene);
}

void cameraInside(MixedScene& scene, RenderOptions& options)
{
    scene.addVolume(bumpy(), WARM);
    addSlantedPlane(scene);
    scene.addMesh(sphereMesh({20, 24, 20}, 5.0, 24, 12), RED);
    options.perspective(60.0).lookAt({13, 4, 17}, {18, 30, 16}, {0, 0, 1});
    options.computeNearFar = false; // the near plane cuts through volume and surfaces
}

void mirror(MixedScene& scene, RenderOptions& options)
{
    scene.addVolume(bumpy(), WARM,
                    osg::Matrixd::scale(1, -1, 1) * osg::Matrixd::translate(0, 32, 0));
    addSlantedPlane(scene);
    scene.addMesh(sphereMesh({10, 24, 12}, 6.0, 24, 12), RED);
    options.view = options.view * osg::Matrixd::scale(-1, 1, 1);
}

void offAxis(MixedScene& scene, RenderOptions& options)
{
    slantedPlane(scene, options);
    scene.addMesh(sphereMesh({10, 24, 12}, 6.0, 24, 12), RED);
    options.projection.makeFrustum(-0.9, 0.2, -0.1, 0.8, 1.0, 1000.0);
    options.lookAt({70, -50, 60}, {43, 16, -8}, {0, 0, 1});
}

void orthographic(MixedScene& scene, RenderOptions& options)
{
    scene.addVolume(bumpy(), WARM);
    addSlantedPlane(scene);
    scene.addMesh(sphereMesh(MIDDLE, 9.0, 24, 12), RED);
    options.orthographic(27.0);
}

void opaqueInside(MixedScene& scene, RenderOptions&)
{
    scene.addVolume(bumpy(), WARM);
    addSlantedPlane(scene);
    scene.addMesh(sphereMesh({24, 12, 18}, 7.0, 24, 12), {0.9, 0.9, 0.9, 1.0}, true);
}

const Scene SCENES[] = {{"SlantedPlane", slantedPlane, 0.9},
                        {"CrossingPlanes", crossingPlanes, 0.9},
                        {"NestedSpheres", nestedSpheres, 0.9},
                        {"ThinRods", thinRods, 0.9},
                        {"Particles", particles, 0.9},
                        {"TwoVolumes", twoVolumes, 1.9},
                        {"ThreeVolumes", threeVolumes, 1.9},
                        {"TwoVolumesAndPlane", twoVolumesAndPlane, 0.9},
                        {"DeformedVolume", deformedVolume, 1.9, 4.0, 2e-4},
                        {"MeshAndPlane", meshAndPlane, -1.0, 4.0, 1e-5},
                        {"MeshInVolume", meshInVolume, 1.8, 4.0, 1e-4},
                        {"CornerInVolume", cornerInVolume, 1.4, 2.0, 1e-4},
                        {"MeshesAndPlane", meshesAndPlane, 1.5, 1.0, 1e-4},
                        {"CameraInside", cameraInside, 0.9},
                        {"Mirror", mirror, 0.9},
                        {"OffAxis", offAxis, 0.9},
                        {"Orthographic", orthographic, 0.9},
                        {"OpaqueInside", opaqueInside, 0.9}};

class MergeScene : public support::GLTest, public ::testing::WithParamInterface<Scene>
{
};

TEST_P(MergeScene, AgreesWithTheOracle)
{
    MixedScene scene;
    RenderOptions options = perspectiveView();
    GetParam().build(scene, options);
    for (const auto& volume : scene.volumes())
        support::filterExactly(*volume); // for the order of sampling
    const oracle::Camera camera = cameraOf(options);
    const FloatImage expected = oracle::render(scene.truth(), camera);
    const support::Mask away =
        support::coveredPixels(oracle::awayFromSilhouettes(scene.truth(), camera));
    std::vector<double> periods, errors;
    for (double period = GetParam().coarsest; period > 0.2; period *= 0.5) {
        scene.setPeriod(period);
        const Judged j = judge(scene, options, expected, away);
        periods.push_back(period);
        errors.push_back(j.away.rmse);
        std::printf(
            "  period %5.2f: rmse %.2e (away %.2e), maximum away %.2e at %d %d, bias %.1e\n",
            period, j.all.rmse, j.away.rmse, j.away.maximum, j.away.worstX, j.away.worstY,
            j.away.bias);
        if (period != 1.0) continue;
        save(j, std::string("merge_") + GetParam().name);
        EXPECT_LE(j.all.rmse, GetParam().error);
    }
    const double order = support::convergenceOrder(periods, errors);
    std::printf("  order %.2f\n", order);
    EXPECT_GE(order, GetParam().order);
}

INSTANTIATE_TEST_SUITE_P(All, MergeScene, ::testing::ValuesIn(SCENES),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace

} // namespace MergeSceneTest
