#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "DistanceField.h"

#include <glm/vec3.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A box with rounded corners; a sphere where it has no size. Its inside or its outside is kept.
struct CutShape
{
    glm::dvec3 center{0.0}, halfSize{0.0};
    double radius = 0.0; ///< of the rounding, outside the box
    bool keepInside = true;

    /// To its surface, positive in what is kept.
    double distance(const glm::dvec3& p) const;
    /// Lowest and highest of a box's.
    ValueRange rangeIn(const Box3d& box) const;
};

/// What is left of a volume where regions cut it: all that lies in every one of them. In the frame
/// that its owner says, with one unit along all axes. Immutable once made.
struct OSGVOLUMIZER_CORE_EXPORT Cut
{
    std::vector<Plane> planes; ///< half-spaces that are kept; normals have length 1
    std::vector<CutShape> shapes;
    std::shared_ptr<const DistanceField> field; ///< null where there is none
    double softness = 0.0; ///< width of the fading from all to nothing, half of it outside
    unsigned id = 0;       ///< differs for every cut ever made

    bool empty() const { return planes.empty() && shapes.empty() && !field; }
    /// The smallest of the signed distances to the regions' surfaces.
    double distance(const glm::dvec3& place) const;
    /// How much is left at a place, 0 to 1.
    double share(const glm::dvec3& place) const;
    /// Certain answers; false also where it is not known.
    bool keepsNothingOf(const Box3d& box) const;
    bool keepsAllOf(const Box3d& box) const;
    /// The parts of the line from `start` to `end` where at least half is left, as parameters
    /// within [0, 1], in order.
    /// \param resolution gaps and parts shorter than that may be missed
    std::vector<std::pair<double, double>> keptParts(const glm::dvec3& start, const glm::dvec3& end,
                                                     double resolution) const;

private:
    ValueRange rangeIn(const Box3d& box) const;
};

/// A number that no other cut has had. Thread safe.
OSGVOLUMIZER_CORE_EXPORT unsigned nextCutId();

} // namespace core
} // namespace osgVolumizer
