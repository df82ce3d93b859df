#include "Polygonize.h"

#include "../geometry/BoxIndex.h"
#include "ClipRecords.h"
#include "Refine.h"
#include "SurfaceFamily.h"
#include "TetraCases.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::size_t MAX_RANGES = std::size_t(1) << 26;

/// Six times the signed volume.
double orientation(const TetraSet& set, const TetraSet::Index* tetra)
{
    const glm::dvec3 a = set.vertices.position(tetra[0]);
    const glm::dvec3 b = set.vertices.position(tetra[1]) - a;
    const glm::dvec3 c = set.vertices.position(tetra[2]) - a;
    const glm::dvec3 d = set.vertices.position(tetra[3]) - a;
    return glm::dot(glm::cross(b, c), d);
}

/// Number of surfaces on the near side of which a vertex lies. Surface k is at k + 1/2, and a
/// vertex on it belongs to its far side. The subtraction is exact wherever the result matters.
int layersPassed(double f, int count)
{
    const double n = std::ceil(f - 0.5);
    return n <= 0.0 ? 0 : n >= count ? count : static_cast<int>(n);
}

/// The order in which surfaces are seen, where the eye is between the planes: by distance from it.
void orderByDistance(const std::vector<double>& depths, double eye, std::vector<int>& order)
{
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return std::abs(depths[std::size_t(a)] - eye) > std::abs(depths[std::size_t(b)] - eye);
    });
}

} // namespace

struct Polygonizer::Private
{
    std::shared_ptr<const TetraSet> tetraSet;
    Box3d bounds;
    BoxIndex boxes;      // as set
    BoxIndex localBoxes; // relative to localOrigin
    glm::dvec3 localOrigin{0.0};

    // One view: scratch.
    Refiner refiner;
    TetraSet refined;
    const TetraSet* sampled = nullptr;
    double nearest = 0.0, farthest = 0.0;
    std::vector<double> depths;        // per vertex, relative to the anchor
    std::vector<double> layers;        // per vertex, in layers from the far end
    std::vector<int> order, rank;      // surfaces far to near, and the inverse
    std::vector<double> surfaceDepths; // per lattice surface
    RecordPolygon polygon, clipped;
    std::vector<std::uint32_t> faceKeys; // surface and brick of each face, in order of making
    std::vector<std::uint8_t> faceSizes;
    std::vector<float> faceSpacings;
    std::vector<std::uint32_t> cursor;

    /// What the pass over the tetrahedra needs to know.
    struct Pass
    {
        const TetraSet* set = nullptr;
        SurfaceLattice lattice;
        int firstSurface = 0, surfaceCount = 0, brickCount = 1;
        bool primitive = false;
        glm::dvec3 origin{0.0};
        int clipField = 0;
    };

    /// Depths of all vertices, of a refined set where a tolerance is asked for.
    Status measure(const Refiner::Function& depth, double tolerance);
    Status cut(const SurfaceLattice& lattice, bool primitive, double eyeDepth,
               const glm::dvec3& origin, PolygonizedFaces& out);
    void shiftBoxes(const glm::dvec3& origin);
    Status makeFaces(Pass& pass, PolygonizedFaces& out);
    void sampleTetra(const Pass& pass, const TetraSet::Index* tetra, PolygonizedFaces& out);
    void makePolygon(const Pass& pass, const TetraSet::Index* tetra, const TetraCase& which,
                     const double* depth, double surface, bool flip);
    void emit(const Pass& pass, const RecordPolygon& face, int surface, int brick, double spacing,
              PolygonizedFaces& out);
    void clipAndEmit(const Pass& pass, int surface, double spacing, PolygonizedFaces& out);
    void sortFaces(const Pass& pass, PolygonizedFaces& out);
};

Polygonizer::Polygonizer() : _private(new Private) {}
Polygonizer::~Polygonizer() = default;
Polygonizer::Polygonizer(Polygonizer&&) noexcept = default;
Polygonizer& Polygonizer::operator=(Polygonizer&&) noexcept = default;

Status Polygonizer::setTetraSet(std::shared_ptr<const TetraSet> tetraSet)
{
    if (Status s = tetraSet->validate(); !s) return s;
    _private->tetraSet = std::move(tetraSet);
    _private->bounds = _private->tetraSet->bounds();
    return {};
}

const std::shared_ptr<const TetraSet>& Polygonizer::tetraSet() const
{
    return _private->tetraSet;
}

Status Polygonizer::setClipBoxes(const std::vector<Box3d>& clipBoxes)
{
    BoxIndex boxes;
    if (Status s = boxes.build(clipBoxes); !s) return s;
    _private->boxes = _private->localBoxes = std::move(boxes);
    _private->localOrigin = glm::dvec3(0.0);
    return {};
}

void Polygonizer::Private::makePolygon(const Pass& pass, const TetraSet::Index* tetra,
                                       const TetraCase& which, const double* depth, double surface,
                                       bool flip)
{
    const VertexArray& vertices = pass.set->vertices;
    const int stride = vertices.format().stride();
    const int position = vertices.format().positionOffset();
    polygon.reset(stride);
    for (int i = 0; i < which.count; ++i) {
        const auto c = static_cast<std::size_t>(flip ? which.count - 1 - i : i);
        const int a = which.farVertex[c], b = which.nearVertex[c];
        const double* p = vertices.record(tetra[a]);
        const double* q = vertices.record(tetra[b]);
        const double t = (surface - depth[a]) / (depth[b] - depth[a]);
        double* r = polygon.append();
        for (int k = 0; k < stride; ++k)
            r[k] = p[k] + t * (q[k] - p[k]);
        for (int k = 0; k < 3; ++k) {
            const double o = pass.origin[k], start = p[position + k] - o;
            r[position + k] = start + t * ((q[position + k] - o) - start);
        }
    }
    polygon.close();
}

void Polygonizer::Private::emit(const Pass& pass, const RecordPolygon& face, int surface, int brick,
                                double spacing, PolygonizedFaces& out)
{
    const std::size_t n = face.size();
    const auto stride = static_cast<std::size_t>(out.faces.format.stride());
    std::vector<float>& v = out.faces.vertices;
    const std::size_t at = v.size();
    v.resize(at + n * stride);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < stride; ++k)
            v[at + i * stride + k] = static_cast<float>(face.record(i)[k]);
    faceKeys.push_back(static_cast<std::uint32_t>(rank[static_cast<std::size_t>(surface)]) *
                           static_cast<std::uint32_t>(pass.brickCount) +
                       static_cast<std::uint32_t>(brick));
    faceSizes.push_back(static_cast<std::uint8_t>(n));
    if (pass.primitive) faceSpacings.push_back(static_cast<float>(spacing));
}

void Polygonizer::Private::clipAndEmit(const Pass& pass, int surface, double spacing,
                                       PolygonizedFaces& out)
{
    if (localBoxes.boxes().empty()) {
        emit(pass, polygon, surface, 0, spacing, out);
        return;
    }
    Box3d extent;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const double* r = polygon.record(i) + pass.clipField;
        extent.expand({r[0], r[1], r[2]});
    }
    localBoxes.visit(extent.min, extent.max, [&](int brick, bool needsClipping) {
        if (!needsClipping) {
            emit(pass, polygon, surface, brick, spacing, out);
            return;
        }
        clipped.assign(polygon);
        clipped.clipBox(pass.clipField, localBoxes.boxes()[static_cast<std::size_t>(brick)]);
        if (clipped.size() >= 3) emit(pass, clipped, surface, brick, spacing, out);
    });
}

void Polygonizer::Private::sampleTetra(const Pass& pass, const TetraSet::Index* tetra,
                                       PolygonizedFaces& out)
{
    double f[4];
    double low = layers[tetra[0]], high = low;
    for (int i = 0; i < 4; ++i) {
        f[i] = layers[tetra[i]];
        low = std::min(low, f[i]);
        high = std::max(high, f[i]);
    }
    if (!(low < high)) return;
    int count = pass.lattice.count;
    double scale = 1.0;
    const double offset = low;
    if (pass.primitive) {
        // The tetrahedron's own layers, no thicker than those of the whole set.
        count = std::max(1, static_cast<int>(std::ceil((high - low) * (1.0 - 1e-9))));
        scale = count / (high - low);
        for (double& v : f)
            v = (v - offset) * scale;
    }
    int passed[4];
    for (int i = 0; i < 4; ++i)
        passed[i] = layersPassed(f[i], count);
    const int first = *std::min_element(passed, passed + 4);
    const int last = *std::max_element(passed, passed + 4);
    if (first == last) return;
    const bool flip = orientation(*pass.set, tetra) < 0.0;
    for (int k = first; k < last; ++k) {
        unsigned mask = 0;
        for (int i = 0; i < 4; ++i)
            mask |= passed[i] > k ? 1u << i : 0u;
        makePolygon(pass, tetra, TETRA_CASES[mask], f, k + 0.5, flip);
        int surface = k;
        if (pass.primitive) {
            const double layer = offset + (k + 0.5) / scale;
            surface = std::min(pass.lattice.count - 1, std::max(0, static_cast<int>(layer)));
        }
        surface -= pass.firstSurface;
        if (surface < 0 || surface >= pass.surfaceCount) continue;
        clipAndEmit(pass, surface, pass.lattice.spacing / scale, out);
    }
}

void Polygonizer::Private::sortFaces(const Pass& pass, PolygonizedFaces& out)
{
    const std::size_t keys =
        static_cast<std::size_t>(pass.surfaceCount) * static_cast<std::size_t>(pass.brickCount);
    out.ranges.assign(keys, FaceRange());
    for (std::size_t f = 0; f < faceKeys.size(); ++f) {
        FaceRange& r = out.ranges[faceKeys[f]];
        ++r.faceCount;
        r.indexCount += faceSizes[f];
    }
    std::uint32_t face = 0, index = 0;
    for (FaceRange& r : out.ranges) {
        r.firstFace = face;
        r.firstIndex = index;
        face += r.faceCount;
        index += r.indexCount;
        r.faceCount = r.indexCount = 0;
    }
    out.faces.indices.resize(index);
    out.faces.faceOffsets.resize(face + 1);
    out.faces.faceOffsets[face] = index;
    out.faceSpacings.resize(pass.primitive ? face : 0);
    std::uint32_t vertex = 0;
    for (std::size_t f = 0; f < faceKeys.size(); ++f) {
        FaceRange& r = out.ranges[faceKeys[f]];
        const std::uint32_t to = r.firstIndex + r.indexCount;
        out.faces.faceOffsets[r.firstFace + r.faceCount] = to;
        if (pass.primitive) out.faceSpacings[r.firstFace + r.faceCount] = faceSpacings[f];
        for (std::uint32_t i = 0; i < faceSizes[f]; ++i)
            out.faces.indices[to + i] = vertex++;
        ++r.faceCount;
        r.indexCount += faceSizes[f];
    }
}

Status Polygonizer::Private::makeFaces(Pass& pass, PolygonizedFaces& out)
{
    const VertexFormat& format = pass.set->vertices.format();
    pass.brickCount = std::max<int>(1, static_cast<int>(boxes.boxes().size()));
    if (static_cast<std::size_t>(pass.surfaceCount) * static_cast<std::size_t>(pass.brickCount) >
        MAX_RANGES)
        return {ErrorCode::TOO_LARGE, "polygonize: " + std::to_string(pass.surfaceCount) +
                                          " surfaces times " + std::to_string(pass.brickCount) +
                                          " bricks are more than 2^26."};
    out.faces.format = format;
    out.faces.clear();
    faceKeys.clear();
    faceSizes.clear();
    faceSpacings.clear();
    for (std::size_t i = 0; i < pass.set->indices.size(); i += 4)
        sampleTetra(pass, pass.set->indices.data() + i, out);
    sortFaces(pass, out);
    return {};
}

void Polygonizer::Private::shiftBoxes(const glm::dvec3& origin)
{
    if (origin == localOrigin) return;
    std::vector<Box3d> shifted = boxes.boxes();
    for (Box3d& b : shifted)
        b = {b.min - origin, b.max - origin};
    localBoxes.build(shifted);
    localOrigin = origin;
}

/// The layers of the view volume, or for voxel axes those of a lattice through the voxel frame.
SurfaceLattice viewLattice(const ViewFamily& family, double nearest, double farthest, int maximum)
{
    const double h = family.wantedSpacing;
    if (family.mode != SamplingMode::AXIS_ALIGNED) {
        if (std::isfinite(family.viewFar))
            return makeLattice(family.viewNear, family.viewFar, h, maximum);
        const double layers = std::ceil(std::max(1.0, (farthest - family.viewNear) / h));
        return makeLattice(family.viewNear, family.viewNear + layers * h, h, maximum);
    }
    const double low = nearest + family.anchorDepth, high = farthest + family.anchorDepth;
    double spacing = h * std::max(1.0, std::ceil((high - low) / h / maximum));
    while (std::ceil(high / spacing) - std::floor(low / spacing) > maximum)
        spacing *= 2.0;
    SurfaceLattice lattice;
    lattice.spacing = spacing;
    lattice.farDepth = std::ceil(high / spacing) * spacing - family.anchorDepth;
    lattice.count = static_cast<int>(std::ceil(high / spacing) - std::floor(low / spacing));
    return lattice;
}

Status Polygonizer::polygonize(const View& view, const SamplingParameters& parameters,
                               PolygonizedFaces& out)
{
    Private& p = *_private;
    const Result<ViewFamily> family = ViewFamily::create(
        *p.tetraSet, p.tetraSet->empty() ? Box3d{glm::dvec3(0), glm::dvec3(0)} : p.bounds, view,
        parameters);
    if (!family) return family.status;
    const auto depth = [&](const double* position, const double* voxel) {
        return family->depth(position, voxel);
    };
    const double tolerance =
        family->linear() ? 0.0 : parameters.curvedTolerance * family->wantedSpacing;
    if (Status s = p.measure(depth, tolerance); !s) return s;
    SurfaceLattice lattice;
    if (parameters.space == SamplingSpace::VIEW_VOLUME)
        lattice = viewLattice(*family, p.nearest, p.farthest, parameters.maximumSamples);
    else
        lattice =
            makeLattice(p.nearest, p.farthest, family->wantedSpacing, parameters.maximumSamples);
    const bool primitive = parameters.space == SamplingSpace::PRIMITIVE;
    if (Status s = p.cut(lattice, primitive, family->eyeDepth, parameters.outputOrigin, out); !s)
        return s;
    const double sign = family->axis >= 0 ? family->gradient[family->axis] : 1.0;
    for (double& d : out.surfaceDepths)
        d = sign * (d + family->anchorDepth);
    out.axis = family->axis;
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
    const auto depth = [&](const double* position, const double* voxel) {
        return family.depth({position[0], position[1], position[2]},
                            {voxel[0], voxel[1], voxel[2]});
    };
    if (Status s = p.measure(depth, tolerance * spacing); !s) return s;
    const SurfaceLattice lattice =
        makeLattice(p.nearest, p.farthest, spacing, parameters.maximumSamples);
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (Status s = p.cut(lattice, false, none, parameters.outputOrigin, out); !s) return s;
    out.axis = -1;
    return {};
}

Status Polygonizer::Private::measure(const Refiner::Function& depth, double tolerance)
{
    sampled = tetraSet.get();
    if (tolerance > 0.0) {
        if (Status s = refiner.refine(*tetraSet, bounds, depth, tolerance, refined, depths); !s)
            return s;
        sampled = &refined;
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
    nearest = std::numeric_limits<double>::infinity();
    farthest = -nearest;
    for (const TetraSet::Index i : sampled->indices) {
        if (!std::isfinite(depths[i]))
            return {ErrorCode::VALUE_INVALID,
                    "polygonize: the depth of vertex " + std::to_string(i) + " is not finite.", i};
        nearest = std::min(nearest, depths[i]);
        farthest = std::max(farthest, depths[i]);
    }
    if (sampled->empty()) nearest = farthest = 0.0;
    return {};
}

Status Polygonizer::Private::cut(const SurfaceLattice& lattice, bool primitive, double eyeDepth,
                                 const glm::dvec3& origin, PolygonizedFaces& out)
{
    Pass pass;
    pass.set = sampled;
    pass.lattice = lattice;
    pass.primitive = primitive;
    pass.origin = origin;
    // The surfaces that the set reaches; a set without volume reaches none.
    const double scale = 1.0 / lattice.spacing;
    pass.firstSurface = layersPassed((lattice.farDepth - farthest) * scale, lattice.count);
    pass.surfaceCount =
        layersPassed((lattice.farDepth - nearest) * scale, lattice.count) - pass.firstSurface;
    layers.resize(depths.size());
    for (std::size_t i = 0; i < depths.size(); ++i)
        layers[i] = (lattice.farDepth - depths[i]) * scale;

    surfaceDepths.resize(static_cast<std::size_t>(pass.surfaceCount));
    order.resize(surfaceDepths.size());
    rank.resize(surfaceDepths.size());
    for (std::size_t k = 0; k < surfaceDepths.size(); ++k) {
        surfaceDepths[k] =
            lattice.farDepth - (pass.firstSurface + static_cast<int>(k) + 0.5) * lattice.spacing;
        order[k] = static_cast<int>(k);
    }
    if (!std::isnan(eyeDepth)) orderByDistance(surfaceDepths, eyeDepth, order);
    for (std::size_t k = 0; k < order.size(); ++k)
        rank[static_cast<std::size_t>(order[k])] = static_cast<int>(k);

    pass.clipField = sampled->vertices.format().voxelCoordinateSize == 3
                         ? sampled->vertices.format().voxelCoordinateOffset()
                         : sampled->vertices.format().positionOffset();
    shiftBoxes(sampled->vertices.format().voxelCoordinateSize == 3 ? glm::dvec3(0.0) : origin);
    if (Status s = makeFaces(pass, out); !s) return s;
    out.surfaceCount = pass.surfaceCount;
    out.brickCount = pass.brickCount;
    out.spacing = lattice.spacing;
    out.surfaceDepths.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        out.surfaceDepths[k] = surfaceDepths[static_cast<std::size_t>(order[k])];
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
