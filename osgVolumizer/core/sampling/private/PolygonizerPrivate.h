#pragma once

#include "../Polygonize.h"
#include "../Refine.h"
#include "../SurfaceFamily.h"
#include "Slicer.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// What a Polygonizer keeps from view to view.
struct Polygonizer::Private
{
    std::shared_ptr<const TetraSet> tetraSet;
    Box3d bounds;
    BoxIndex boxes; // as set

    TetraBlocks blocks; // of the tetra set, about an origin
    BoxIndex localBoxes;
    bool blocksCurrent = false, placesCurrent = false;

    // One view.
    TetraBlocks refinedBlocks;
    Refiner refiner;
    TetraSet refined;
    std::vector<double> depths; // per vertex, where they are not those of planes
    std::vector<DepthRange> parentRanges, primitiveRanges; // per tetrahedron, refined or not
    std::vector<double> surfaceDepths;
    std::vector<int> order; // surfaces, far to near
    SlicePlan plan;
    Slicer slicer;
    double nearest = 0.0, farthest = 0.0;

    Status prepareBlocks(const glm::dvec3& origin);
    void usePlanes(const ViewFamily& family, const glm::dvec3& origin);
    Status useFunction(const Refiner::Function& depth, double tolerance, const glm::dvec3& origin);
    /// PRIMITIVE: gives the pieces of a refined tetrahedron the layers of the whole.
    void spreadOverParents();
    Status measure();
    Status cut(const SurfaceLattice& lattice, double eyeDepth, PolygonizedFaces& out);
    Status cutPlane(const Plane& plane, const glm::dvec3& origin,
                    const std::vector<std::vector<Plane>>* pieces, PolygonizedFaces& out);
};

} // namespace core
} // namespace osgVolumizer
