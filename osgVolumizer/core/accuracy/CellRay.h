#pragma once

#include "../Export.h"
#include "../transfer/ExtinctionTable.h"
#include "../transfer/IntervalTable.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// The value at a position of the voxel frame, as a fraction of the voxels' range; NaN where
/// nothing shows.
using FractionField = std::function<double(const glm::dvec3& positionVoxel)>;

/// A ray through voxels that are interpolated linearly: in each of the cells between samples that
/// it passes, its value is a cubic polynomial, so that four values a cell say all there is to know
/// of it; or through voxels of which the nearest counts, one value a cell about each.
class OSGVOLUMIZER_CORE_EXPORT CellRay
{
public:
    /// From `begin` to `end`, voxel frame, which differ. Asks the field three times a cell, or with
    /// `nearest` once.
    CellRay(const FractionField& field, const glm::dvec3& beginVoxel, const glm::dvec3& endVoxel,
            double lengthUnits, bool nearest);

    double lengthVoxel() const { return _ends.back(); }
    std::size_t cellCount() const { return _ends.size(); }

    /// Premultiplied colour and opacity, composited from about equal steps, as the renderer does
    /// it: each takes the table's entry at its middle, or with integrals the mean over the values
    /// between its ends. Ends early where less than `opaqueEnough` of the light passes. The
    /// midpoint rule is of second order.
    glm::dvec4 integrate(const ExtinctionTable& table, double periodVoxel,
                         double opaqueEnough) const;
    /// The same from pieces that end at faces of cells and where the value turns round or passes a
    /// corner of the table, and are no longer than `longestVoxel`, nor than what lets half of the
    /// light through. Each takes two samples: see
    /// lightOfPiece().
    glm::dvec4 integrate(const IntervalTable& table, double longestVoxel,
                         double opaqueEnough) const;
    /// Number of pieces of the latter.
    std::size_t pieceCount(const IntervalTable& table, double longestVoxel) const;

private:
    template <class Visit>
    void visitPieces(const IntervalTable& table, double longestVoxel, const Visit& visit) const;

    std::vector<double> _ends;      ///< of cells, from the ray's beginning, voxels
    std::vector<glm::vec4> _values; ///< at 0, 1/3, 2/3 and 1 of each cell
    double _unitsPerVoxel;
    bool _nearest; ///< values of cells have nothing to do with one another
};

/// Light of a piece of a ray, premultiplied colour and opacity, from colour and extinction (bits
/// per unit) at the two points of Gauss's rule, through which both are taken for linear. Where they
/// are smooth it is off by the fifth power of the length, so of fourth order along a ray.
OSGVOLUMIZER_CORE_EXPORT glm::dvec4 lightOfPiece(const glm::dvec4& first, const glm::dvec4& second,
                                                 double lengthUnits);

} // namespace core
} // namespace osgVolumizer
