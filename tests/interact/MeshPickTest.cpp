// Picks of unstructured grids: where the light of scalars becomes so opaque, or a value is reached.
#include "PickOracle.h"

#include <oracles/MeshOracle.h>
#include <oracles/TestMeshes.h>

namespace MeshPickTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using A = VolumeAppearance;

namespace {

struct Picked
{
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(5));
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    osg::ref_ptr<A> appearance = new A;
    const Points points = {{0.0, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 0.1}}, {1.0, {1, 1, 1, 0.9}}};

    Picked()
    {
        oracle::jitter(mesh, 0.04, 3);
        const oracle::GaussianField field(glm::dvec3(0.4, 0.5, 0.6), 0.3);
        oracle::sampleField(mesh, field);
        EXPECT_TRUE(geometry->setTetraSet(oracle::tetraSet(mesh)).ok());
        EXPECT_TRUE(geometry->setScalarRange(osg::Vec2d(0.0, 1.0)).ok());
        EXPECT_TRUE(geometry->setScalars({mesh.scalars.begin(), mesh.scalars.end()}).ok());
        appearance->setLookupTable(makeTable(points));
        appearance->setOpacityUnit(0.2);
        appearance->addChild(geometry);
    }
    // Scalar at a place of a line, NaN outside.
    double valueAt(const oracle::MeshOracle& truth, const Line& line, double ratio) const
    {
        for (const auto& part :
             truth.segments(line.at(0.0), line.at(1.0) - line.at(0.0), 0.0, 1.0)) {
            if (ratio < part.enter - 1e-9 || ratio > part.leave + 1e-9) continue;
            const double f = (ratio - part.enter) / (part.leave - part.enter);
            double value = 0.0;
            for (std::size_t k = 0; k < 4; ++k)
                value += ((1.0 - f) * part.enterWeights[k] + f * part.leaveWeights[k]) *
                         mesh.scalars[mesh.cells[part.cell][k]];
            return value;
        }
        return NAN;
    }
};

TEST(MeshPick, FindsWhereTheLightIsHalfGone)
{
    const Picked picked;
    const oracle::MeshOracle truth(picked.mesh, oracle::Table(picked.points), 0.2);
    RandomLines lines(glm::dvec3(-0.2), glm::dvec3(1.2));
    int hits = 0;
    for (int i = 0; i < 600; ++i) {
        const Line line = lines.next();
        const auto found = pickLine(*picked.appearance, line);
        const glm::dvec3 start = line.at(0.0), direction = line.at(1.0) - start;
        const double whole = truth.light(start, direction, 0.0, 1.0).a;
        if (std::fabs(whole - 0.5) < 1e-3) continue;
        ASSERT_EQ(found.has_value(), whole > 0.5) << i << ' ' << whole;
        if (!found) continue;
        EXPECT_NEAR(truth.light(start, direction, 0.0, found->ratio).a, 0.5, 1e-3) << i;
        ++hits;
    }
    EXPECT_GT(hits, 50);
}

TEST(MeshPick, FindsValues)
{
    const Picked picked;
    const oracle::MeshOracle truth(picked.mesh, oracle::Table(picked.points), 0.2);
    picked.appearance->setIsoValue(0.6);
    RandomLines lines(glm::dvec3(-0.2), glm::dvec3(1.2));
    int crossings = 0;
    for (int i = 0; i < 400; ++i) {
        const Line line = lines.next();
        picked.appearance->setRayFunction(A::ISOSURFACE);
        const auto iso = pickLine(*picked.appearance, line);
        if (iso) {
            EXPECT_NEAR(picked.valueAt(truth, line, iso->ratio), 0.6, 1e-6) << i;
            EXPECT_NEAR(iso->value, 0.6, 1e-6) << i;
            ++crossings;
        }
        picked.appearance->setRayFunction(A::MAXIMUM);
        const auto highest = pickLine(*picked.appearance, line);
        if (!highest) continue;
        const double value = picked.valueAt(truth, line, highest->ratio);
        for (double ratio = 0.01; ratio < 1.0; ratio += 0.01)
            EXPECT_FALSE(picked.valueAt(truth, line, ratio) > value + 1e-6) << i;
    }
    EXPECT_GT(crossings, 30);
}

TEST(MeshPick, CellsWithoutAValueAreNotHit)
{
    const Picked picked;
    std::vector<float> scalars(picked.mesh.cells.size(), NAN);
    scalars[40] = 1.0f;
    ASSERT_TRUE(picked.geometry->setScalars(scalars, VolumeGeometry::PER_TETRAHEDRON).ok());
    glm::dvec3 middle(0.0);
    for (std::size_t k = 0; k < 4; ++k)
        middle += 0.25 * picked.mesh.corner(picked.mesh.cells[40], k);
    Line line;
    line.start = middle - glm::dvec3(2, 1, 1.5);
    line.end = middle + glm::dvec3(2, 1, 1.5);
    picked.appearance->setOpacityUnit(1e-3);
    const auto found = pickLine(*picked.appearance, line);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->tetrahedron, 40u);
}

} // namespace

} // namespace MeshPickTest
