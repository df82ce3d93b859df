#include "private/PolygonizerPrivate.h"

#include "../geometry/ConvexPieces.h"

#include <cmath>
#include <limits>
#include <string>

namespace osgVolumizer {
namespace core {

Status Polygonizer::Private::cutPlane(const Plane& plane, const glm::dvec3& origin,
                                      const std::vector<std::vector<Plane>>* pieces,
                                      PolygonizedFaces& out)
{
    const glm::dvec3& n = plane.normal;
    const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(plane.offset / length))
        return {ErrorCode::VALUE_INVALID,
                "polygonizeMPR: the plane's normal has length " + std::to_string(length) + "."};
    SamplingParameters parameters;
    parameters.outputOrigin = origin;
    if (Status s = parameters.validate(); !s) return s;
    if (Status s = prepareBlocks(origin); !s) return s;
    plan.blocks = &blocks;
    plan.depths = nullptr;
    plan.gradient = n / -length;
    plan.depthField = tetraSet->vertices.format().positionOffset();
    plan.corner = n * (-plane.offset / (length * length)) - origin;
    plan.primitive = false;
    plan.pieces = pieces;
    plan.visible.clear();
    if (Status s = measure(); !s) return s;
    // One layer, with the plane in its middle.
    SurfaceLattice lattice;
    lattice.farDepth = 0.5;
    lattice.count = 1;
    Status s = cut(lattice, std::numeric_limits<double>::quiet_NaN(), out);
    plan.pieces = nullptr;
    if (!s) return s;
    out.axis = -1;
    out.gradient = plan.gradient;
    out.spacing = 0.0;
    return {};
}

Status Polygonizer::polygonizeMPR(const Plane& plane, const glm::dvec3& outputOrigin,
                                  PolygonizedFaces& out)
{
    return _private->cutPlane(plane, outputOrigin, nullptr, out);
}

Status Polygonizer::polygonizeMPR(const std::vector<glm::dvec3>& polygon,
                                  const glm::dvec3& outputOrigin, PolygonizedFaces& out)
{
    Plane plane;
    std::vector<std::vector<Plane>> pieces;
    if (Status s = convexPieces(polygon, plane, pieces); !s) return s;
    for (std::vector<Plane>& piece : pieces)
        for (Plane& p : piece)
            p.offset += p.normal.x * outputOrigin.x + p.normal.y * outputOrigin.y +
                        p.normal.z * outputOrigin.z;
    return _private->cutPlane(plane, outputOrigin, &pieces, out);
}

} // namespace core
} // namespace osgVolumizer
