// Cells of every kind that VTK reads, as tetrahedra.

#if defined(OSGVOLUMIZER_HAVE_VTK) && defined(OSGVOLUMIZER_HAVE_VTK_IMAGES)

#include "VtkCellMesh.h"
#include "VtkFiles.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/geometry/TetraMesh.h>
#include <support/OuterFaces.h>

#include <osgDB/ReadFile>

#include <vtkUnsignedCharArray.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <glm/geometric.hpp>

#include <set>

namespace VtkCellsTest {

using namespace osgVolumizer;

namespace {

using Points = VtkCellMesh::Points;
using Field = std::function<double(const glm::dvec3&)>;

glm::dvec3 unmoved(const glm::dvec3& p)
{
    return p;
}

// Leaves the boundary of the unit cube where it is.
glm::dvec3 bent(const glm::dvec3& p)
{
    constexpr double PI = 3.14159265358979323846;
    return p + 0.05 * std::sin(PI * p.x) * std::sin(PI * p.y) * std::sin(PI * p.z) *
                   glm::dvec3(1.0, -0.7, 0.4);
}

Points boxCorners(const glm::dvec3& low, const glm::dvec3& high)
{
    const auto at = [&](int x, int y, int z) {
        return glm::dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    return {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
            at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
}

std::vector<Points> facesOfBox(const Points& c)
{
    return {{c[0], c[3], c[2], c[1]}, {c[4], c[5], c[6], c[7]}, {c[0], c[1], c[5], c[4]},
            {c[1], c[2], c[6], c[5]}, {c[2], c[3], c[7], c[6]}, {c[3], c[0], c[4], c[7]}};
}

struct Family
{
    const char* name;
    int hexa, hexaNodes, wedge, wedgeNodes, pyramid, pyramidNodes, tetra, tetraNodes;
};
const Family FAMILIES[] = {
    {"linear", VTK_HEXAHEDRON, 8, VTK_WEDGE, 6, VTK_PYRAMID, 5, VTK_TETRA, 4},
    {"quadratic", VTK_QUADRATIC_HEXAHEDRON, 20, VTK_QUADRATIC_WEDGE, 15, VTK_QUADRATIC_PYRAMID, 13,
     VTK_QUADRATIC_TETRA, 10},
    {"triquadratic", VTK_TRIQUADRATIC_HEXAHEDRON, 27, VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18,
     VTK_TRIQUADRATIC_PYRAMID, 19, VTK_LAGRANGE_TETRAHEDRON, 15},
    {"lagrange 2", VTK_LAGRANGE_HEXAHEDRON, 27, VTK_LAGRANGE_WEDGE, 21, VTK_TRIQUADRATIC_PYRAMID,
     19, VTK_LAGRANGE_TETRAHEDRON, 10},
    {"lagrange 3", VTK_LAGRANGE_HEXAHEDRON, 64, VTK_LAGRANGE_WEDGE, 40, 0, 0,
     VTK_LAGRANGE_TETRAHEDRON, 20},
    {"lagrange 4", VTK_LAGRANGE_HEXAHEDRON, 125, VTK_LAGRANGE_WEDGE, 75, 0, 0,
     VTK_LAGRANGE_TETRAHEDRON, 35}};

// The unit cube in four columns: hexahedra, wedges, hexahedra as six pyramids each, and as
// pyramids and tetrahedra.
VtkCellMesh mixedMesh(const Family& family)
{
    VtkCellMesh mesh;
    for (int z = 0; z < 2; ++z)
        for (int column = 0; column < 4; ++column) {
            const glm::dvec3 low(0.5 * (column % 2), 0.5 * (column / 2), 0.5 * z);
            const Points c = boxCorners(low, low + 0.5);
            if (column == 0 || (column > 1 && !family.pyramid)) {
                mesh.add(family.hexa, family.hexaNodes, c);
            } else if (column == 1) {
                mesh.add(family.wedge, family.wedgeNodes, {c[0], c[1], c[2], c[4], c[5], c[6]});
                mesh.add(family.wedge, family.wedgeNodes, {c[0], c[2], c[3], c[4], c[6], c[7]});
            } else {
                for (const Points& f : facesOfBox(c)) {
                    const glm::dvec3 middle = low + glm::dvec3(0.25);
                    const glm::dvec3 outside = f[0] + f[1] + f[2] + f[3] - 4.0 * middle;
                    if (column == 3 && outside.x > 0.5) { // at the boundary of the whole
                        mesh.add(family.tetra, family.tetraNodes, {f[0], f[1], f[2], middle});
                        mesh.add(family.tetra, family.tetraNodes, {f[0], f[2], f[3], middle});
                    } else {
                        mesh.add(family.pyramid, family.pyramidNodes,
                                 {f[0], f[1], f[2], f[3], middle});
                    }
                }
            }
        }
    return mesh;
}

class VtkCells : public VtkFolderTest
{
protected:
    /// Gives its points the values of a field.
    static void fill(vtkUnstructuredGrid& grid, const Field& field)
    {
        std::vector<double> values;
        for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
            double p[3];
            grid.GetPoint(i, p);
            values.push_back(field({p[0], p[1], p[2]}));
        }
        addArray<vtkDoubleArray>(grid.GetPointData(), "field", 1, values);
    }
    /// Null, and an error, where it cannot be read.
    osg::ref_ptr<VolumeGeometry> load(vtkUnstructuredGrid& grid, const std::string& options = {})
    {
        write<vtkXMLUnstructuredGridWriter>("a.vtu", &grid, vtkXMLWriter::Appended);
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        o->setObjectCacheHint(osgDB::Options::CACHE_NONE);
        auto result = osgDB::Registry::instance()->readNode(path("a.vtu"), o);
        _error = result.message();
        auto* appearance = dynamic_cast<VolumeAppearance*>(result.getNode());
        return appearance ? dynamic_cast<VolumeGeometry*>(appearance->getChild(0)) : nullptr;
    }
    const std::string& error() const { return _error; }

    static std::size_t facesInside(const core::TetraSet& set)
    {
        std::size_t inside = 0;
        const core::Adjacency adjacency = core::findAdjacency(set);
        EXPECT_TRUE(adjacency.nonManifold.empty());
        for (const auto& face : support::outerFaces(set)) {
            bool onBoundary = false;
            for (int axis = 0; axis < 3; ++axis)
                for (const double plane : {0.0, 1.0})
                    onBoundary =
                        onBoundary || std::all_of(face.begin(), face.end(), [&](auto vertex) {
                            return std::abs(set.vertices.position(vertex)[axis] - plane) < 1e-12;
                        });
            inside += !onBoundary;
        }
        return inside;
    }
    /// Of the scalars at the vertices that are used.
    static double greatestError(const VolumeGeometry& volume, const Field& field)
    {
        const VolumeGeometry::TetraSetPtr set = volume.getTetraSet();
        double greatest = 0.0;
        for (const auto i : set->indices)
            greatest = std::max(
                greatest, std::abs((*volume.getScalars())[i] - field(set->vertices.position(i))));
        return greatest;
    }

private:
    std::string _error;
};

} // namespace

TEST_F(VtkCells, NeighboursOfAllKindsAgree)
{
    const Field linear = [](const glm::dvec3& p) { return 1.0 + 2.0 * p.x - 3.0 * p.y + p.z; };
    for (const Family& family : FAMILIES)
        for (unsigned seed = 0; seed < 5; ++seed)
            for (const bool curved : {false, true}) {
                const VtkCellMesh mesh = mixedMesh(family);
                const auto grid = mesh.grid(seed, curved ? bent : unmoved);
                fill(*grid, linear);
                const auto volume = load(*grid);
                ASSERT_TRUE(volume && volume->getScalars()) << family.name << error();
                const core::TetraSet& set = *volume->getTetraSet();
                EXPECT_EQ(facesInside(set), 0u) << family.name << seed << curved;
                EXPECT_NEAR(core::volume(set), 1.0, 1e-12) << family.name << seed << curved;
                EXPECT_EQ(volume->getScalarBinding(), VolumeGeometry::PER_VERTEX);
                EXPECT_LT(greatestError(*volume, linear), 1e-6) << family.name;
            }
    EXPECT_EQ(told(), "");
}

// Into eight of each, but ten of a pyramid, and as many for higher degrees.
TEST_F(VtkCells, EveryNodeIsACorner)
{
    const struct
    {
        int type, nodes, corners, used;
        double volume;
    } kinds[] = {{VTK_VOXEL, 8, 8, 8, 1.0},
                 {VTK_QUADRATIC_TETRA, 10, 4, 10, 1.0 / 6.0},
                 {VTK_QUADRATIC_HEXAHEDRON, 20, 8, 27, 1.0},
                 {VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24, 8, 27, 1.0},
                 {VTK_TRIQUADRATIC_HEXAHEDRON, 27, 8, 27, 1.0},
                 {VTK_QUADRATIC_LINEAR_WEDGE, 12, 6, 12, 0.5},
                 {VTK_QUADRATIC_WEDGE, 15, 6, 18, 0.5},
                 {VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18, 6, 18, 0.5},
                 {VTK_QUADRATIC_PYRAMID, 13, 5, 14, 1.0 / 3.0},
                 {VTK_TRIQUADRATIC_PYRAMID, 19, 5, 14, 1.0 / 3.0},
                 {VTK_LAGRANGE_HEXAHEDRON, 64, 8, 64, 1.0},
                 {VTK_LAGRANGE_WEDGE, 40, 6, 40, 0.5},
                 {VTK_LAGRANGE_WEDGE, 21, 6, 18, 0.5},
                 {VTK_LAGRANGE_TETRAHEDRON, 35, 4, 35, 1.0 / 6.0},
                 {VTK_BEZIER_TETRAHEDRON, 20, 4, 20, 1.0 / 6.0},
                 {VTK_BEZIER_HEXAHEDRON, 27, 8, 27, 1.0},
                 {VTK_BEZIER_WEDGE, 18, 6, 18, 0.5}};
    const Points box = boxCorners(glm::dvec3(0.0), glm::dvec3(1.0));
    for (const auto& kind : kinds) {
        Points corners = box;
        if (kind.corners == 4) corners = {box[0], box[1], box[3], box[4]};
        if (kind.corners == 5) corners = {box[0], box[1], box[2], box[3], box[4]};
        if (kind.corners == 6) corners = {box[0], box[1], box[3], box[4], box[5], box[7]};
        VtkCellMesh mesh;
        mesh.add(kind.type, kind.nodes, corners);
        const auto grid = mesh.grid(7, unmoved);
        // Serendipity functions and Lagrange's hold all quadratic ones; Bezier's nodes are moved.
        const bool bezier = kind.type >= VTK_BEZIER_CURVE;
        const Field field = [bezier](const glm::dvec3& p) {
            return bezier ? p.x + 2.0 * p.y : p.x * p.x - p.x * p.y + p.z * (p.y + 2.0 * p.z);
        };
        fill(*grid, field);
        const auto volume = load(*grid);
        ASSERT_TRUE(volume && volume->getScalars()) << kind.type << error();
        const core::TetraSet& set = *volume->getTetraSet();
        EXPECT_NEAR(core::volume(set), kind.volume, 1e-12) << kind.type;
        EXPECT_TRUE(core::findAdjacency(set).nonManifold.empty()) << kind.type;
        const std::set<core::TetraSet::Index> used(set.indices.begin(), set.indices.end());
        EXPECT_EQ(static_cast<int>(used.size()), kind.used) << kind.type;
        EXPECT_LT(greatestError(*volume, field), 1e-6) << kind.type;
    }
}

// The error of quadratic cells is of second order, and that of linear ones of half their size.
TEST_F(VtkCells, ErrorIsOfSecondOrderInTheDistanceOfNodes)
{
    const Field field = [](const glm::dvec3& p) {
        return std::sin(3.0 * p.x) * std::cos(2.0 * p.y + p.z);
    };
    const auto errorOf = [&](int type, int nodes, int cells) {
        VtkCellMesh mesh;
        for (int i = 0; i < cells * cells * cells; ++i) {
            const glm::dvec3 low(i % cells, i / cells % cells, i / cells / cells);
            mesh.add(type, nodes, boxCorners(low / double(cells), (low + 1.0) / double(cells)));
        }
        const auto grid = mesh.grid(1, unmoved);
        fill(*grid, field);
        const auto volume = load(*grid);
        if (!volume || !volume->getScalars()) return -1.0;
        const VolumeGeometry::TetraSetPtr set = volume->getTetraSet();
        const core::PointLocator locator(*set);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> anywhere(0.0, 1.0);
        double sum = 0.0;
        constexpr int SAMPLES = 4000;
        for (int i = 0; i < SAMPLES; ++i) {
            const glm::dvec3 p(anywhere(random), anywhere(random), anywhere(random));
            const auto place = locator.locate(p);
            double value = 0.0;
            for (std::size_t k = 0; place && k < 4; ++k)
                value += place->weights[int(k)] *
                         (*volume->getScalars())[set->indices[4 * place->tetrahedron + k]];
            sum += (value - field(p)) * (value - field(p));
        }
        return std::sqrt(sum / SAMPLES);
    };
    const double linear = errorOf(VTK_HEXAHEDRON, 8, 4);
    const double coarse = errorOf(VTK_QUADRATIC_HEXAHEDRON, 20, 4);
    const double fine = errorOf(VTK_QUADRATIC_HEXAHEDRON, 20, 8);
    const double cubic = errorOf(VTK_LAGRANGE_HEXAHEDRON, 64, 4);
    EXPECT_GT(fine, 0.0);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
    EXPECT_NEAR(linear / coarse, 4.0, 0.5);
    EXPECT_NEAR(linear / cubic, 9.0, 1.5);
    RecordProperty("linear", std::to_string(linear));
    RecordProperty("quadratic", std::to_string(coarse));
}

// A quarter of a pipe, exactly, by rational weights.
TEST_F(VtkCells, NodesOfBezierCellsLieOnTheirCurves)
{
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    std::vector<double> weights, radii;
    std::vector<vtkIdType> ids;
    for (const glm::dvec3& p : VtkCellMesh::nodesOf(VTK_BEZIER_HEXAHEDRON, 27)) {
        const double r = 1.0 + p.x;
        const bool between = p.y == 0.5;
        points->InsertNextPoint(p.y < 0.75 ? r : 0.0, p.y > 0.25 ? r : 0.0, p.z);
        weights.push_back(between ? std::sqrt(0.5) : 1.0);
        radii.push_back(r);
        ids.push_back(static_cast<vtkIdType>(ids.size()));
    }
    grid->SetPoints(points);
    grid->InsertNextCell(VTK_BEZIER_HEXAHEDRON, 27, ids.data());
    addArray<vtkDoubleArray>(grid->GetPointData(), "radius", 1, radii);
    addArray<vtkDoubleArray>(grid->GetPointData(), "RationalWeights", 1, weights);
    grid->GetPointData()->SetActiveAttribute("RationalWeights",
                                             vtkDataSetAttributes::RATIONALWEIGHTS);
    const auto volume = load(*grid);
    ASSERT_TRUE(volume && volume->getScalars()) << error();
    EXPECT_EQ(volume->getName(), "radius");
    EXPECT_LT(greatestError(*volume, [](const glm::dvec3& p) { return std::hypot(p.x, p.y); }),
              1e-6);
    EXPECT_EQ(volume->getTetraSet()->vertices.size(), 27u);
}

TEST_F(VtkCells, DegreesMayDiffer)
{
    // One, two and three steps along the axes, as Lagrange cells number their nodes.
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    std::vector<vtkIdType> ids;
    const auto add = [&](double x, double y, double z) {
        points->InsertNextPoint(x, y / 2.0, z / 3.0);
        ids.push_back(static_cast<vtkIdType>(ids.size()));
    };
    for (const int z : {0, 3})
        for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 2}, {0, 2}})
            add(x, y, z);
    for (const int z : {0, 3})
        for (const int x : {1, 0})
            add(x, 1, z);
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 2}, {0, 2}})
        for (const int z : {1, 2})
            add(x, y, z);
    for (const int x : {0, 1})
        for (const int z : {1, 2})
            add(x, 1, z);
    ASSERT_EQ(ids.size(), 24u);
    grid->SetPoints(points);
    grid->InsertNextCell(VTK_LAGRANGE_HEXAHEDRON, 24, ids.data());
    addArray<vtkIntArray>(grid->GetCellData(), "degrees", 3, std::vector<int>{1, 2, 3});
    grid->GetCellData()->SetActiveAttribute("degrees", vtkDataSetAttributes::HIGHERORDERDEGREES);
    fill(*grid, [](const glm::dvec3& p) { return p.x; });
    const auto volume = load(*grid);
    ASSERT_TRUE(volume) << error();
    EXPECT_NEAR(core::volume(*volume->getTetraSet()), 1.0, 1e-12);
    EXPECT_EQ(facesInside(*volume->getTetraSet()), 0u);
    EXPECT_GE(volume->getTetraSet()->tetraCount(), 30u);

    grid->GetCellData()->GetArray("degrees")->SetComponent(0, 0, 2);
    grid->GetCellData()->Modified();
    EXPECT_FALSE(load(*grid));
    EXPECT_NE(error().find("cell 0 has 24 points"), std::string::npos) << error();
}

// Boxes that are stated as polyhedra, sets of points, voxels and hexahedra, side by side.
TEST_F(VtkCells, PolyhedraAgreeWithOtherCells)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        VtkCellMesh mesh;
        for (int i = 0; i < 27; ++i) {
            const glm::dvec3 low(i % 3, i / 3 % 3, i / 9);
            const Points c = boxCorners(low / 3.0, (low + 1.0) / 3.0);
            if (i % 3 == 0)
                mesh.addFaces(facesOfBox(c));
            else if (i % 3 == 1 && i % 2 == 0)
                mesh.addPoints({c[2], c[0], c[1], c[7], c[3], c[4], c[5], c[6]});
            else
                mesh.add(VTK_HEXAHEDRON, 8, c);
        }
        const auto grid = mesh.grid(seed, unmoved);
        fill(*grid, [](const glm::dvec3& p) { return p.x; });
        const auto volume = load(*grid);
        ASSERT_TRUE(volume) << error();
        EXPECT_EQ(facesInside(*volume->getTetraSet()), 0u) << seed;
        EXPECT_NEAR(core::volume(*volume->getTetraSet()), 1.0, 1e-12);
        // They are convex: nothing is added.
        EXPECT_EQ(volume->getTetraSet()->vertices.size(), 64u);
    }
}

// A cube less six pyramids that point inwards, which fill it.
TEST_F(VtkCells, PolyhedraNeedNotBeConvex)
{
    const Field field = [](const glm::dvec3& p) { return p.x + 2.0 * p.y - p.z; };
    int added = 0;
    for (unsigned seed = 0; seed < 8; ++seed) {
        VtkCellMesh mesh;
        const Points c = boxCorners(glm::dvec3(0.0), glm::dvec3(1.0));
        std::vector<Points> faces;
        for (const Points& f : facesOfBox(c)) {
            const glm::dvec3 middle = 0.25 * (f[0] + f[1] + f[2] + f[3]);
            const glm::dvec3 dent = middle + 0.4 * (glm::dvec3(0.5) - middle);
            for (std::size_t i = 0; i < 4; ++i)
                faces.push_back({f[i], f[(i + 1) % 4], dent});
            mesh.add(VTK_PYRAMID, 5, {f[0], f[1], f[2], f[3], dent});
        }
        mesh.addFaces(faces);
        const auto grid = mesh.grid(seed, unmoved);
        fill(*grid, field);
        const auto volume = load(*grid);
        ASSERT_TRUE(volume) << error();
        EXPECT_EQ(facesInside(*volume->getTetraSet()), 0u) << seed;
        EXPECT_NEAR(core::volume(*volume->getTetraSet()), 1.0, 1e-12) << seed;
        added += static_cast<int>(volume->getTetraSet()->vertices.size()) - 14;
        EXPECT_LT(greatestError(*volume, field), 1e-6);
    }
    // No corner of the cube sees all of it, but the points of dents do.
    EXPECT_GT(added, 0);
    EXPECT_LT(added, 8);
}

TEST_F(VtkCells, PrismsOverPentagonsAndHexagons)
{
    for (const int n : {5, 6}) {
        vtkNew<vtkUnstructuredGrid> grid;
        vtkNew<vtkPoints> points;
        points->SetDataTypeToDouble();
        vtkNew<vtkIdList> ids;
        for (int i = 0; i < 2 * n; ++i) {
            const double angle = 6.28318530717958647692 * i / n;
            points->InsertNextPoint(std::cos(angle), std::sin(angle), i / n);
            ids->InsertNextId(i);
        }
        grid->SetPoints(points);
        grid->InsertNextCell(n == 5 ? VTK_PENTAGONAL_PRISM : VTK_HEXAGONAL_PRISM, ids);
        fill(*grid, [](const glm::dvec3& p) { return p.z; });
        const auto volume = load(*grid);
        ASSERT_TRUE(volume) << error();
        EXPECT_NEAR(core::volume(*volume->getTetraSet()),
                    0.5 * n * std::sin(6.28318530717958647692 / n), 1e-12);
        EXPECT_EQ(volume->getTetraSet()->vertices.size(), static_cast<std::size_t>(2 * n));
    }
}

} // namespace VtkCellsTest

#endif
