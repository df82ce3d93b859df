#include "Polygonize.h"

#include "private/PolygonizerPrivate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double NO_DEPTH = std::numeric_limits<double>::quiet_NaN();

/// The order in which surfaces are seen, where the eye is between the planes: by distance from it.
void orderByDistance(const std::vector<double>& depths, double eye, std::vector<int>& order)
{
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const double da = std::abs(depths[std::size_t(a)] - eye);
        const double db = std::abs(depths[std::size_t(b)] - eye);
        return da != db ? da > db : a < b;
    });
}

/// The layers of the view volume, or for voxel axes those of a lattice through the voxel frame.
SurfaceLattice viewLattice(const ViewFamily& family, double nearest, double farthest, int maximum)
{
    const double h = family.wantedSpacing;
    if (family.mode != SamplingMode::AXIS_ALIGNED) {
        // Spread in absolute depths, so that all sets get the same surfaces to the bit.
        double farDepth = family.viewFar;
        if (!std::isfinite(farDepth)) {
            const double reach = farthest + family.anchorDepth - family.viewNear;
            farDepth = family.viewNear + std::ceil(std::max(1.0, reach / h)) * h;
        }
        SurfaceLattice lattice = makeLattice(family.viewNear, farDepth, h, maximum);
        lattice.farDepth -= family.anchorDepth;
        return lattice;
    }
    const double low = nearest + family.anchorDepth, high = farthest + family.anchorDepth;
    double spacing = h * std::max(1.0, std::ceil((high - low) / h / maximum));
    while (std::ceil(high / spacing) - std::floor(low / spacing) > maximum)
        spacing *= 2.0;
    const double layers = std::ceil(high / spacing) - std::floor(low / spacing);
    SurfaceLattice lattice;
    lattice.spacing = spacing;
    lattice.farDepth = std::ceil(high / spacing) * spacing - family.anchorDepth;
    lattice.count = layers >= 1.0 && layers <= maximum ? static_cast<int>(layers) : 0;
    return lattice;
}

/// The half-spaces that hold all that a view can show: the four sides, and what is before the eye.
/// Near and far are left out, because OSG settles them only after the cull.
void visibleHalfSpaces(const View& view, const glm::dvec3& origin, std::vector<Plane>& planes)
{
    const glm::dmat4 m = view.projection * view.toEye;
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    for (const glm::dvec4& p :
         {row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(3)}) {
        const glm::dvec3 n(p);
        planes.push_back({n, p.w + n.x * origin.x + n.y * origin.y + n.z * origin.z});
    }
}

} // namespace

Polygonizer::Polygonizer() : _private(new Private) {}
Polygonizer::~Polygonizer() = default;
Polygonizer::Polygonizer(Polygonizer&&) noexcept = default;
Polygonizer& Polygonizer::operator=(Polygonizer&&) noexcept = default;

Status Polygonizer::setTetraSet(std::shared_ptr<const TetraSet> tetraSet)
{
    if (Status s = tetraSet->validate(); !s) return s;
    _private->tetraSet = std::move(tetraSet);
    _private->bounds = _private->tetraSet->bounds();
    if (_private->tetraSet->empty()) _private->bounds = {glm::dvec3(0.0), glm::dvec3(0.0)};
    _private->blocksCurrent = false;
    return {};
}

const std::shared_ptr<const TetraSet>& Polygonizer::tetraSet() const
{
    return _private->tetraSet;
}

Status Polygonizer::setClipBoxes(const std::vector<Box3d>& clipBoxes)
{
    if (clipBoxes == _private->boxes.boxes()) return {};
    BoxIndex boxes;
    if (Status s = boxes.build(clipBoxes); !s) return s;
    _private->boxes = std::move(boxes);
    _private->placesCurrent = false;
    return {};
}

Status Polygonizer::Private::prepareBlocks(const glm::dvec3& origin)
{
    if (!blocksCurrent || blocks.origin() != origin) {
        blocks.build(*tetraSet, origin);
        blocksCurrent = true;
        placesCurrent = false;
    }
    if (!placesCurrent) {
        std::vector<Box3d> shifted = boxes.boxes();
        if (tetraSet->vertices.format().voxelCoordinateSize != 3)
            for (Box3d& b : shifted)
                b = {b.min - origin, b.max - origin};
        if (Status s = localBoxes.build(shifted); !s) return s;
        blocks.place(localBoxes);
        placesCurrent = true;
    }
    plan.boxes = &localBoxes;
    plan.brickCount = std::max(1, static_cast<int>(localBoxes.boxes().size()));
    return {};
}

void Polygonizer::Private::usePlanes(const ViewFamily& family, const glm::dvec3& origin)
{
    const VertexFormat& format = tetraSet->vertices.format();
    const bool voxels =
        family.mode == SamplingMode::AXIS_ALIGNED && format.voxelCoordinateSize == 3;
    plan.blocks = &blocks;
    plan.depths = nullptr;
    plan.gradient = family.gradient;
    plan.depthField = voxels ? format.voxelCoordinateOffset() : format.positionOffset();
    plan.corner = voxels ? family.corner : family.corner - origin;
}

Status Polygonizer::Private::useFunction(const Refiner::Function& depth, double tolerance,
                                         const glm::dvec3& origin)
{
    plan.blocks = &blocks;
    if (tolerance > 0.0) {
        if (Status s = refiner.refine(*tetraSet, bounds, depth, tolerance, refined, depths); !s)
            return s;
        refinedBlocks.build(refined, origin);
        refinedBlocks.place(localBoxes);
        plan.blocks = &refinedBlocks;
    } else {
        const VertexArray& vertices = tetraSet->vertices;
        const VertexFormat& format = vertices.format();
        const bool voxels = format.voxelCoordinateSize == 3;
        depths.resize(vertices.size());
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const double* r = vertices.record(i);
            const double* position = r + format.positionOffset();
            depths[i] = depth(position, voxels ? r + format.voxelCoordinateOffset() : position);
        }
    }
    plan.depths = depths.data();
    return {};
}

void Polygonizer::Private::spreadOverParents()
{
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    const std::vector<std::uint32_t>& parents = refiner.parents();
    parentRanges.assign(tetraSet->tetraCount(), {INFINITE, -INFINITE});
    for (std::size_t i = 0; i < parents.size(); ++i) {
        DepthRange& range = parentRanges[parents[i]];
        for (std::size_t k = 0; k < 4; ++k) {
            const double d = depths[refined.indices[4 * i + k]];
            range.nearest = std::min(range.nearest, d);
            range.farthest = std::max(range.farthest, d);
        }
    }
    primitiveRanges.resize(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i)
        primitiveRanges[i] = parentRanges[parents[i]];
    plan.primitiveRanges = primitiveRanges.data();
}

Status Polygonizer::Private::measure()
{
    const TetraBlocks& b = *plan.blocks;
    nearest = std::numeric_limits<double>::infinity();
    farthest = -nearest;
    double poison = 0.0; // NaN as soon as one depth is not finite
    const auto look = [&](const TetraBlocks::Block& block) {
        for (std::uint32_t i = block.firstVertex; i < block.firstVertex + block.vertexCount; ++i) {
            const double d = Slicer::depthOf(plan, b.record(i), b.sourceVertices[i]);
            poison += d - d;
            nearest = std::min(nearest, d);
            farthest = std::max(farthest, d);
        }
    };
    // The extremes lie in few blocks: those that reach farthest come first, the others are looked
    // into only if they may reach farther still.
    struct Range
    {
        double nearest, farthest;
    };
    std::size_t nearBlock = 0, farBlock = 0;
    Range nearRange{nearest, farthest}, farRange{nearest, farthest};
    for (std::size_t i = 0; i < b.blocks.size(); ++i) {
        Range r{};
        Slicer::depthRange(plan, b.blocks[i], r.nearest, r.farthest);
        poison += std::isnan(r.nearest) || std::isnan(r.farthest) ? r.nearest - r.farthest : 0.0;
        if (r.nearest < nearRange.nearest) nearRange = r, nearBlock = i;
        if (r.farthest > farRange.farthest) farRange = r, farBlock = i;
    }
    if (!b.blocks.empty()) {
        look(b.blocks[nearBlock]);
        look(b.blocks[farBlock]);
    }
    for (const TetraBlocks::Block& block : b.blocks) {
        Range r{};
        Slicer::depthRange(plan, block, r.nearest, r.farthest);
        if (r.nearest < nearest || r.farthest > farthest) look(block);
    }
    if (!(poison == 0.0))
        return {ErrorCode::VALUE_INVALID, "polygonize: the depth of a vertex is not finite."};
    if (b.sourceVertices.empty()) nearest = farthest = 0.0;
    return {};
}

Status Polygonizer::Private::cut(const SurfaceLattice& lattice, double eyeDepth,
                                 PolygonizedFaces& out)
{
    plan.lattice = lattice;
    const double scale = 1.0 / lattice.spacing;
    if (!std::isfinite(lattice.farDepth) || !(scale > 0.0) || !std::isfinite(scale))
        return {ErrorCode::VALUE_INVALID, "polygonize: surfaces at a distance of " +
                                              std::to_string(lattice.spacing) +
                                              " are beyond double precision."};
    // The surfaces that the set reaches; a set without volume reaches none.
    plan.firstSurface = surfacesPassed((lattice.farDepth - farthest) * scale, 0, lattice.count);
    plan.surfaceCount =
        surfacesPassed((lattice.farDepth - nearest) * scale, 0, lattice.count) - plan.firstSurface;
    if (Status s = Slicer::checkSize(plan); !s) return s;
    const auto n = static_cast<std::size_t>(plan.surfaceCount);
    surfaceDepths.resize(n);
    order.resize(n);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = 0; k < n; ++k)
        surfaceDepths[k] =
            lattice.farDepth - (plan.firstSurface + static_cast<int>(k) + 0.5) * lattice.spacing;
    if (!std::isnan(eyeDepth)) orderByDistance(surfaceDepths, eyeDepth, order);
    plan.order = order.data();

    if (Status s = slicer.run(plan, out); !s) return s;
    out.surfaceCount = plan.surfaceCount;
    out.brickCount = plan.brickCount;
    out.spacing = lattice.spacing;
    out.surfaceDepths.resize(n);
    for (std::size_t k = 0; k < n; ++k)
        out.surfaceDepths[k] = surfaceDepths[static_cast<std::size_t>(order[k])];
    return {};
}

Status Polygonizer::polygonize(const View& view, const SamplingParameters& parameters,
                               PolygonizedFaces& out)
{
    Private& p = *_private;
    const Result<ViewFamily> family = ViewFamily::create(*p.tetraSet, p.bounds, view, parameters);
    if (!family) return family.status;
    if (Status s = p.prepareBlocks(parameters.outputOrigin); !s) return s;
    if (family->linear()) {
        p.usePlanes(*family, parameters.outputOrigin);
    } else {
        const auto depth = [&](const double* position, const double* voxel) {
            return family->depth(position, voxel);
        };
        if (Status s = p.useFunction(depth, parameters.curvedTolerance * family->wantedSpacing,
                                     parameters.outputOrigin);
            !s)
            return s;
    }
    p.plan.primitive = parameters.space == SamplingSpace::PRIMITIVE;
    p.plan.primitiveRanges = nullptr;
    if (p.plan.primitive && !family->linear()) p.spreadOverParents();
    p.plan.visible.clear();
    if (parameters.cullToView) visibleHalfSpaces(view, parameters.outputOrigin, p.plan.visible);
    if (Status s = p.measure(); !s) return s;
    const SurfaceLattice lattice =
        parameters.space == SamplingSpace::VIEW_VOLUME
            ? viewLattice(*family, p.nearest, p.farthest, parameters.maximumSamples)
            : makeLattice(p.nearest, p.farthest, family->wantedSpacing, parameters.maximumSamples);
    if (Status s = p.cut(lattice, family->eyeDepth, out); !s) return s;
    const double sign = family->axis >= 0 ? family->gradient[family->axis] : 1.0;
    for (double& d : out.surfaceDepths)
        d = sign * (d + family->anchorDepth);
    out.axis = family->axis;
    out.gradient = family->linear() ? family->gradient : glm::dvec3(0.0);
    return {};
}

Status Polygonizer::polygonize(const SurfaceFamily& family, const SamplingParameters& parameters,
                               PolygonizedFaces& out)
{
    Private& p = *_private;
    if (Status s = parameters.validate(); !s) return s;
    const double spacing = family.spacing(), tolerance = family.tolerance();
    if (!(spacing > 0.0) || !std::isfinite(spacing) || !(tolerance >= 0.0))
        return {ErrorCode::VALUE_INVALID, "SurfaceFamily: spacing " + std::to_string(spacing) +
                                              " and tolerance " + std::to_string(tolerance) +
                                              " must be positive."};
    if (Status s = p.prepareBlocks(parameters.outputOrigin); !s) return s;
    const auto depth = [&](const double* position, const double* voxel) {
        return family.depth({position[0], position[1], position[2]},
                            {voxel[0], voxel[1], voxel[2]});
    };
    if (Status s = p.useFunction(depth, tolerance * spacing, parameters.outputOrigin); !s) return s;
    p.plan.primitive = false;
    p.plan.visible.clear();
    if (Status s = p.measure(); !s) return s;
    if (Status s = p.cut(makeLattice(p.nearest, p.farthest, spacing, parameters.maximumSamples),
                         NO_DEPTH, out);
        !s)
        return s;
    out.axis = -1;
    out.gradient = glm::dvec3(0.0);
    return {};
}

Status polygonize(const TetraSet& tetraSet, const std::vector<Box3d>& clipBoxes, const View& view,
                  const SamplingParameters& parameters, PolygonizedFaces& out)
{
    Polygonizer polygonizer;
    // The set outlives the call, so nothing needs to own it.
    if (Status s = polygonizer.setTetraSet({std::shared_ptr<const TetraSet>(), &tetraSet}); !s)
        return s;
    if (Status s = polygonizer.setClipBoxes(clipBoxes); !s) return s;
    return polygonizer.polygonize(view, parameters, out);
}

} // namespace core
} // namespace osgVolumizer
