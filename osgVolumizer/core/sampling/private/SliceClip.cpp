#include "../../private/LargePages.h"
#include "Interpolate.h"
#include "Slicer.h"
#include "TetraCases.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

void append(const SlicePlan& plan, std::size_t bin, double spacing, Slicer::Work& work)
{
    const std::size_t stride = plan.blocks->recordSize();
    const RecordPolygon& face = work.polygon;
    growLarge(work.vertices, work.valueCount + face.size() * stride, work.valueCount);
    float* to = work.vertices.data() + work.valueCount;
    work.valueCount += face.size() * stride;
    for (std::size_t i = 0; i < face.size(); ++i) {
        const double* from = face.record(i);
        for (std::size_t k = 0; k < stride; ++k)
            *to++ = static_cast<float>(from[k]);
    }
    work.bins.push_back(static_cast<std::uint32_t>(bin));
    work.sizes.push_back(static_cast<std::uint16_t>(face.size()));
    if (plan.primitive) work.spacings.push_back(static_cast<float>(spacing));
}

void clipFace(const SlicePlan& plan, int surface, double spacing, Slicer::Work& work)
{
    const std::size_t firstBin = static_cast<std::size_t>(surface - plan.firstSurface) *
                                 static_cast<std::size_t>(plan.brickCount);
    if (!plan.boxes || plan.boxes->boxes().empty()) {
        append(plan, firstBin, spacing, work);
        return;
    }
    const int field = plan.blocks->clipField();
    RecordPolygon& polygon = work.polygon;
    const Box3d extent = polygon.extent(field);
    polygon.save(work.whole);
    bool cut = false;
    plan.boxes->visit(extent.min, extent.max, [&](int brick, bool needsClipping) {
        const std::size_t bin = firstBin + static_cast<std::size_t>(brick);
        if (cut) polygon.restore(work.whole);
        cut = needsClipping;
        if (needsClipping)
            polygon.clipBox(field, plan.boxes->boxes()[static_cast<std::size_t>(brick)], extent);
        if (polygon.size() >= 3) append(plan, bin, spacing, work);
    });
}

} // namespace

void clipTetra(const SlicePlan& plan, const TetraBlocks::Block& block, std::uint32_t tetrahedron,
               const double* layers, Slicer::Work& work)
{
    const TetraBlocks& blocks = *plan.blocks;
    const std::size_t stride = blocks.recordSize();
    const TetraBlocks::Tetra& tetra = blocks.tetrahedra[block.firstTetra + tetrahedron];
    const double* records[4];
    double f[4];
    for (int i = 0; i < 4; ++i) {
        records[i] = blocks.record(block.firstVertex + tetra.v[i]);
        f[i] = layers[tetra.v[i]];
    }
    double low = std::min(std::min(f[0], f[1]), std::min(f[2], f[3]));
    double high = std::max(std::max(f[0], f[1]), std::max(f[2], f[3]));
    if (!(low < high)) return;
    int first = plan.firstSurface, last = first + plan.surfaceCount;
    double scale = 1.0;
    if (plan.primitive) {
        // The tetrahedron's own layers, no thicker than those of the whole set.
        if (plan.primitiveRanges) {
            const DepthRange& range =
                plan.primitiveRanges[blocks.sourceTetrahedra[block.firstTetra + tetrahedron]];
            low = (plan.lattice.farDepth - range.farthest) * (1.0 / plan.lattice.spacing);
            high = (plan.lattice.farDepth - range.nearest) * (1.0 / plan.lattice.spacing);
        }
        last = std::max(1, static_cast<int>(std::ceil((high - low) * (1.0 - 1e-9))));
        scale = last / (high - low);
        if (!std::isfinite(scale)) return; // too thin for layers of its own
        first = 0;
        for (double& v : f)
            v = (v - low) * scale;
    }
    int passed[4];
    for (int i = 0; i < 4; ++i)
        passed[i] = surfacesPassed(f[i], first, last);
    const int end = *std::max_element(passed, passed + 4);
    for (int k = *std::min_element(passed, passed + 4); k < end; ++k) {
        unsigned mask = 0;
        for (int i = 0; i < 4; ++i)
            mask |= passed[i] > k ? 1u << i : 0u;
        const TetraCase& which = TETRA_CASES[mask];
        work.polygon.reset(static_cast<int>(stride));
        for (std::size_t c = 0; c < static_cast<std::size_t>(which.count); ++c) {
            const std::size_t a = which.farVertex[c], b = which.nearVertex[c];
            const double t = (k + 0.5 - f[a]) / (f[b] - f[a]);
            interpolate(records[a], records[b], t, stride, work.polygon.append());
        }
        work.polygon.close();
        int surface = k;
        if (plan.primitive)
            surface =
                std::min(plan.firstSurface + plan.surfaceCount - 1,
                         std::max(plan.firstSurface, static_cast<int>(low + (k + 0.5) / scale)));
        const double spacing = plan.lattice.spacing / scale;
        if (!plan.pieces) {
            clipFace(plan, surface, spacing, work);
            continue;
        }
        work.polygon.save(work.uncut);
        for (const std::vector<Plane>& piece : *plan.pieces) {
            work.polygon.restore(work.uncut);
            for (std::size_t i = 0; i < piece.size() && work.polygon.size() > 0; ++i)
                work.polygon.clipPlane(blocks.format().positionOffset(), piece[i]);
            if (work.polygon.size() >= 3) clipFace(plan, surface, spacing, work);
        }
    }
}

} // namespace core
} // namespace osgVolumizer
