#pragma once

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <tuple>
#include <vector>

/// A mesh of VTK's cells that share their nodes, which have random numbers.
class VtkCellMesh
{
public:
    using Points = std::vector<glm::dvec3>;

    /// VTK's parametric coordinates of the nodes of a kind.
    static Points nodesOf(int type, int count)
    {
        vtkNew<vtkUnstructuredGrid> grid;
        vtkNew<vtkPoints> points;
        std::vector<vtkIdType> ids;
        for (int i = 0; i < count; ++i) {
            points->InsertNextPoint(i, i * i, 1.0);
            ids.push_back(i);
        }
        grid->SetPoints(points);
        grid->InsertNextCell(type, count, ids.data());
        const double* p = grid->GetCell(0)->GetParametricCoords();
        Points nodes;
        for (int i = 0; i < count; ++i, p += 3)
            nodes.emplace_back(p[0], p[1], p[2]);
        return nodes;
    }

    /// A straight cell with nodes at equal steps between its corners, in the order of the linear
    /// kind of as many corners.
    void add(int type, int count, const Points& corners)
    {
        Cell cell{type, {}};
        for (const glm::dvec3& node : corners.size() == 5 ? pyramid(count) : nodesOf(type, count))
            cell.nodes.push_back(numberOf(interpolated(corners, node)));
        _cells.push_back(cell);
    }
    /// A polyhedron of faces.
    void addFaces(const std::vector<Points>& faces)
    {
        Cell cell{VTK_POLYHEDRON, {}};
        cell.nodes.push_back(static_cast<vtkIdType>(faces.size()));
        for (const Points& face : faces) {
            cell.nodes.push_back(static_cast<vtkIdType>(face.size()));
            for (const glm::dvec3& corner : face)
                cell.nodes.push_back(numberOf(corner));
        }
        _cells.push_back(cell);
    }
    /// The convex hull of points.
    void addPoints(const Points& hull)
    {
        Cell cell{VTK_CONVEX_POINT_SET, {}};
        for (const glm::dvec3& point : hull)
            cell.nodes.push_back(numberOf(point));
        _cells.push_back(cell);
    }
    /// The grid, its points moved and numbered at random.
    vtkSmartPointer<vtkUnstructuredGrid>
    grid(unsigned seed, const std::function<glm::dvec3(const glm::dvec3&)>& moved) const
    {
        std::vector<vtkIdType> numbers(points.size());
        for (std::size_t i = 0; i < numbers.size(); ++i)
            numbers[i] = static_cast<vtkIdType>(i);
        std::shuffle(numbers.begin(), numbers.end(), std::mt19937(seed));
        vtkNew<vtkPoints> places;
        places->SetDataTypeToDouble();
        places->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::dvec3 p = moved(points[i]);
            places->SetPoint(numbers[i], p.x, p.y, p.z);
        }
        auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
        result->SetPoints(places);
        for (const Cell& cell : _cells)
            insert(*result, cell, numbers);
        return result;
    }

    Points points;

private:
    struct Cell
    {
        int type;
        std::vector<vtkIdType> nodes; ///< of a polyhedron: its stream of faces
    };

    static void insert(vtkUnstructuredGrid& grid, const Cell& cell,
                       const std::vector<vtkIdType>& numbers)
    {
        vtkNew<vtkIdList> ids;
        vtkIdType left = 0; // of a face
        const bool faces = cell.type == VTK_POLYHEDRON;
        for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
            const bool isCount = faces && (i == 0 || left == 0);
            if (isCount && i > 0) left = cell.nodes[i] + 1;
            if (faces && i > 0) --left;
            ids->InsertNextId(isCount ? cell.nodes[i]
                                      : numbers[static_cast<std::size_t>(cell.nodes[i])]);
        }
        grid.InsertNextCell(cell.type, ids);
    }
    // VTK's coordinates are those of a collapsed cube: the middles of edges between corners
    // instead.
    static Points pyramid(int count)
    {
        static const int edges[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0},
                                        {0, 4}, {1, 4}, {2, 4}, {3, 4}};
        Points nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int i = 0; i + 5 < std::min(count, 13); ++i)
            nodes.push_back(0.5 * (nodes[static_cast<std::size_t>(edges[i][0])] +
                                   nodes[static_cast<std::size_t>(edges[i][1])]));
        if (count == 19) // the middles of the base, the sides and the whole
            nodes.insert(nodes.end(), {{0.5, 0.5, 0.0},
                                       {1.0 / 3.0, 0, 1.0 / 3.0},
                                       {2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                       {1.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0},
                                       {0, 1.0 / 3.0, 1.0 / 3.0},
                                       {0.4, 0.4, 0.2}});
        return nodes;
    }
    // Linear in the coordinates of a unit cell.
    static glm::dvec3 interpolated(const Points& c, const glm::dvec3& p)
    {
        if (c.size() == 4)
            return c[0] + p.x * (c[1] - c[0]) + p.y * (c[2] - c[0]) + p.z * (c[3] - c[0]);
        if (c.size() == 5) // bilinear below, and its apex over the first corner
            return (1.0 - p.z) * bilinear(c, p / std::max(1.0 - p.z, 1e-300)) + p.z * c[4];
        if (c.size() == 6) {
            const auto at = [&](std::size_t i) {
                return c[i] + p.x * (c[i + 1] - c[i]) + p.y * (c[i + 2] - c[i]);
            };
            return (1.0 - p.z) * at(0) + p.z * at(3);
        }
        return (1.0 - p.z) * bilinear(c, p) + p.z * bilinear({c[4], c[5], c[6], c[7]}, p);
    }
    static glm::dvec3 bilinear(const Points& c, const glm::dvec3& p)
    {
        return (1.0 - p.y) * ((1.0 - p.x) * c[0] + p.x * c[1]) +
               p.y * ((1.0 - p.x) * c[3] + p.x * c[2]);
    }
    vtkIdType numberOf(const glm::dvec3& p)
    {
        const auto key =
            std::make_tuple(std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6));
        const auto [found, isNew] = _numbers.emplace(key, static_cast<vtkIdType>(points.size()));
        if (isNew) points.push_back(p);
        return found->second;
    }

    std::vector<Cell> _cells;
    std::map<std::tuple<long, long, long>, vtkIdType> _numbers;
};
