#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeSolids.h>
#include <osgVolumizer/core/geometry/TetraMesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>

namespace VolumeSolidsTest {

using namespace osgVolumizer;

namespace {

constexpr double PI = 3.14159265358979323846;
const osg::Vec3d CENTER(10.0, -20.0, 5.0);
const osg::BoundingBoxd BOX(6.0, -26.0, 0.0, 15.0, -15.0, 12.0);
constexpr double BOX_VOLUME = 9.0 * 11.0 * 12.0;

double volumeOf(const GeometryResult& solid)
{
    EXPECT_TRUE(solid.ok()) << solid.status.text;
    return solid.ok() ? core::volume(*(*solid)->getTetraSet()) : 0.0;
}

bool holds(const GeometryResult& solid, const osg::Vec3d& p)
{
    const VolumeGeometry::TetraSetPtr set = (*solid)->getTetraSet();
    return core::PointLocator(*set).locate({p.x(), p.y(), p.z()}).has_value();
}

core::VertexArray vertexArray(const std::vector<glm::dvec3>& points)
{
    core::VertexArray vertices;
    vertices.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        vertices.setPosition(i, points[i]);
    return vertices;
}

// Two hexahedra on each other: rings of four.
core::VertexArray tower()
{
    std::vector<glm::dvec3> points;
    for (int z = 0; z < 3; ++z)
        for (const glm::dvec2& p : {glm::dvec2(0, 0), {2, 0}, {2, 3}, {0, 3}})
            points.emplace_back(p.x, p.y, 4.0 * z);
    return vertexArray(points);
}

// clang-format off
void addRegions(osgVolumizer::VolumeAppearance* head, const osg::Vec3d& center, const osgVolumizer::core::CellSet& cells, const std::vector<float>& temperatures)
{
const auto ball = osgVolumizer::createGeodesicSphere(center, 20.0); // radius, object frame
if (ball.ok()) head->addChild(*ball); // else ball.status.text says why
const auto grid = osgVolumizer::createCells(cells); // tetrahedra, pyramids, prisms or hexahedra
if (grid.ok() && (*grid)->setScalars(temperatures).ok()) head->addChild(*grid);
} // end
// clang-format on

std::string textOf(const std::string& file)
{
    std::ifstream stream(OSGVOLUMIZER_SOURCE_DIR "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST(VolumeSolids, FillWhatTheirNamesSay)
{
    // Inscribed in circles, they lack (2/3) (pi/n)^2 of the area for n slices.
    const double circle = 0.5 * 64 * std::sin(2.0 * PI / 64), r = 3.0;
    const osg::Vec3d end = CENTER + osg::Vec3d(1.0, 2.0, 2.0);
    EXPECT_NEAR(volumeOf(createCone(CENTER, end, r, 64)), circle * r * r * 3.0 / 3.0, 1e-11);
    EXPECT_NEAR(volumeOf(createCylinder(CENTER, end, r, 64, 4)), circle * r * r * 3.0, 1e-11);
    const double sphere = 4.0 / 3.0 * PI * r * r * r;
    for (const double volume :
         {volumeOf(createSphere(CENTER, r, 64, 64)), volumeOf(createGeodesicSphere(CENTER, r, 16)),
          BOX_VOLUME - volumeOf(createBoxMinusSphere(BOX, CENTER, r, 32))}) {
        EXPECT_LT(volume, sphere);
        EXPECT_GT(volume, 0.99 * sphere);
    }
    const double hole = BOX_VOLUME - volumeOf(createBoxMinusCylinder(BOX, CENTER, 0, r, 32, 2));
    EXPECT_LT(hole, PI * r * r * 9.0);
    EXPECT_GT(hole, 0.99 * PI * r * r * 9.0);
}

TEST(VolumeSolids, LieWhereTheyWerePut)
{
    const osg::Vec3d top = CENTER + osg::Vec3d(0.0, 0.0, 6.0);
    const GeometryResult cone = createCone(CENTER, top, 3.0);
    EXPECT_TRUE(holds(cone, CENTER + osg::Vec3d(2.8, 0.0, 0.1)));
    EXPECT_TRUE(holds(cone, top - osg::Vec3d(0.0, 0.0, 0.1)));
    EXPECT_FALSE(holds(cone, top + osg::Vec3d(2.8, 0.0, -0.1)));
    EXPECT_TRUE(holds(createCylinder(CENTER, top, 3.0), top + osg::Vec3d(2.8, 0.0, -0.1)));
    for (const GeometryResult& sphere :
         {createSphere(CENTER, 3.0), createGeodesicSphere(CENTER, 3.0)}) {
        EXPECT_TRUE(holds(sphere, CENTER + osg::Vec3d(0.0, 2.8, 0.0)));
        EXPECT_FALSE(holds(sphere, CENTER + osg::Vec3d(0.0, 2.8, 2.8)));
    }
    const GeometryResult cavity = createBoxMinusSphere(BOX, CENTER, 3.0);
    const GeometryResult tunnel = createBoxMinusCylinder(BOX, CENTER, 1, 3.0);
    const osg::Vec3d corner(6.1, -25.9, 0.1), wall(10.0, -25.9, 5.0);
    EXPECT_TRUE(holds(cavity, corner) && holds(tunnel, corner));
    EXPECT_TRUE(holds(cavity, wall));
    EXPECT_FALSE(holds(tunnel, wall)); // drilled along y
    EXPECT_FALSE(holds(cavity, CENTER) || holds(tunnel, CENTER));
    EXPECT_EQ((*cavity)->getTetraSet()->bounds().min, glm::dvec3(6.0, -26.0, 0.0));
    EXPECT_EQ((*cavity)->getTetraSet()->bounds().max, glm::dvec3(15.0, -15.0, 12.0));
}

TEST(VolumeSolids, RefusalsAreReturnedAndNotReported)
{
    clearLastError();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const osg::Vec3d bad(0.0, nan, 0.0), far(1e31, 0.0, 0.0);
    const struct
    {
        GeometryResult result;
        ErrorCode code;
        const char* says;
    } refused[] = {
        {createCone(CENTER, CENTER, 1.0), ErrorCode::VALUE_INVALID, "height"},
        {createCylinder(CENTER, bad, 1.0), ErrorCode::VALUE_INVALID, "top"},
        {createCylinder(CENTER, {}, 1.0, 2), ErrorCode::VALUE_INVALID, "slices"},
        {createSphere(CENTER, -1.0), ErrorCode::VALUE_INVALID, "radius"},
        {createSphere(CENTER, 1.0, 1 << 13, 1 << 13), ErrorCode::TOO_LARGE, "tetrahedra"},
        {createSphere(far, 1e30), ErrorCode::VALUE_INVALID, "vertex 0"},
        {createGeodesicSphere(CENTER, 1.0, 0), ErrorCode::VALUE_INVALID, "frequency"},
        {createBoxMinusSphere(BOX, CENTER, 4.0), ErrorCode::VALUE_INVALID, "hole"},
        {createBoxMinusSphere({}, CENTER, 1.0), ErrorCode::VALUE_INVALID, "box"},
        {createBoxMinusCylinder(BOX, CENTER, 3, 1.0), ErrorCode::VALUE_INVALID, "axis"},
        {createCells({core::CellKind::HEXA, tower(), {0, 1, 2}}), ErrorCode::SIZE_MISMATCH, "8"},
        {createStrip(core::StripKind::HEXA, tower(), {0, 1, 2, 3}), ErrorCode::SIZE_MISMATCH, "4"},
    };
    for (const auto& r : refused) {
        EXPECT_EQ(r.result.status.code, r.code) << r.says << ": " << r.result.status.text;
        EXPECT_NE(r.result.status.text.find(r.says), std::string::npos) << r.result.status.text;
        EXPECT_FALSE(r.result.value.valid());
    }
    EXPECT_TRUE(getLastError().ok());
}

TEST(VolumeSolids, CellsAndStripsKeepTheNumbersOfVertices)
{
    std::vector<core::TetraSet::Index> numbers(12);
    std::iota(numbers.begin(), numbers.end(), 0u);
    const core::CellSet cells{
        core::CellKind::HEXA, tower(), {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 9, 10, 11}};
    for (const GeometryResult& made :
         {createCells(cells), createStrip(core::StripKind::HEXA, tower(), numbers)}) {
        EXPECT_NEAR(volumeOf(made), 2.0 * 3.0 * 8.0, 1e-12);
        EXPECT_EQ((*made)->getTetraSet()->vertices.values(), tower().values());
        EXPECT_TRUE((*made)->setScalars(std::vector<float>(12, 1.0f)));
    }
}

TEST(VolumeSolids, AreTheReadmesSample)
{
    const std::string own = textOf("tests/nodes/VolumeSolidsTest.cpp");
    const std::size_t begin = own.find("const auto ball"), end = own.find("} // end");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
    const osg::ref_ptr<VolumeAppearance> head = new VolumeAppearance;
    addRegions(head, CENTER, {core::CellKind::HEXA, tower(), {0, 1, 2, 3, 4, 5, 6, 7}},
               std::vector<float>(12, 1.0f));
    EXPECT_EQ(head->getNumChildren(), 2u);
}

} // namespace VolumeSolidsTest
