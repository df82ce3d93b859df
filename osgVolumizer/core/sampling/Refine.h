#pragma once

#include "../Status.h"
#include "../geometry/EdgeMap.h"
#include "../geometry/TetraSet.h"

#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Bisects tetrahedra until a function is linear along every edge to within a tolerance, without
/// hanging vertices (Ruprecht and Mueller, "A scheme for edge-based adaptive tetrahedron
/// subdivision", 1998). Whether an edge is split depends on its end points only, and the longest
/// such edge of a tetrahedron goes first, so the faces between tetrahedra are split alike from both
/// sides, in any order of the tetrahedra. Keeps its memory from call to call.
class Refiner
{
public:
    /// Splits no edge shorter than this part of the bounds' diagonal.
    static constexpr double SHORTEST_EDGE = 1.0 / 4096.0;
    /// Makes no more tetrahedra than this beyond those there are.
    static constexpr std::size_t MAX_NEW_TETRAHEDRA = std::size_t(1) << 20;

    /// \param value function of (position, voxel coordinate), each three doubles
    /// \param values receives the function at the vertices of `out`
    /// TOO_LARGE where the tolerance needs more than MAX_NEW_TETRAHEDRA.
    using Function = std::function<double(const double*, const double*)>;
    Status refine(const TetraSet& in, const Box3d& bounds, const Function& value, double tolerance,
                  TetraSet& out, std::vector<double>& values);
    /// Per tetrahedron of the last `out`: which one of `in` it is a piece of.
    const std::vector<std::uint32_t>& parents() const { return _parents; }

private:
    /// The vertex in the middle of an edge; made where the edge is to be split, else NONE.
    std::uint32_t middle(TetraSet& out, std::vector<double>& values, TetraSet::Index a,
                         TetraSet::Index b);
    double valueAt(const TetraSet& set, std::size_t vertex) const;

    const Function* _value = nullptr;
    double _tolerance = 0.0;
    double _shortestSquared = 0.0;
    EdgeMap _middles; ///< vertex in the middle, or UNSPLIT
    std::vector<TetraSet::Index> _stack;
    std::vector<std::uint32_t> _parents;
};

} // namespace core
} // namespace osgVolumizer
