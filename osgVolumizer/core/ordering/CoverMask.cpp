#include "CoverMask.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

constexpr int WORD = 64;

// The bits of word `word` of a row from first to last, both included.
std::uint64_t bitsOf(int word, int first, int last)
{
    const int low = std::max(first - word * WORD, 0), high = std::min(last - word * WORD, WORD - 1);
    return (~std::uint64_t(0) >> (WORD - 1 - high)) & (~std::uint64_t(0) << low);
}

} // namespace

/// The corners of a box in pixels, the centre of the first pixel being (0, 0).
struct CoverMask::Projected
{
    glm::dvec2 corners[8];
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};
};

CoverMask::CoverMask(const glm::dmat4& toClip, const glm::ivec2& pixels)
    : _toClip(toClip), _pixels(pixels), _words((std::size_t(pixels.x) + WORD - 1) / WORD),
      _bits(_words * std::size_t(pixels.y), 0)
{
}

bool CoverMask::project(const Box3d& box, Projected& projected) const
{
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 clip = _toClip * glm::dvec4(box.corner(i), 1.0);
        if (!(clip.w > 0.0 && clip.z >= -clip.w)) return false;
        const glm::dvec2 ndc = glm::dvec2(clip) / clip.w;
        projected.corners[i] = (0.5 * ndc + 0.5) * glm::dvec2(_pixels) - 0.5;
        projected.min = glm::min(projected.min, projected.corners[i]);
        projected.max = glm::max(projected.max, projected.corners[i]);
    }
    return std::isfinite(projected.max.x - projected.min.x + projected.max.y - projected.min.y);
}

// What a row of pixel centres has of a convex body's projection lies between the outermost of its
// edges.
void CoverMask::add(const Box3d& box)
{
    Projected projected;
    if (!project(box, projected)) return;
    const double lowest = std::max(projected.min.y, 0.0);
    const double highest = std::min(projected.max.y, _pixels.y - 1.0);
    if (!(lowest <= highest)) return;
    const int firstRow = int(std::ceil(lowest)), lastRow = int(std::floor(highest));
    if (firstRow > lastRow) return;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<glm::dvec2> spans(std::size_t(lastRow - firstRow) + 1, {infinity, -infinity});
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 1; axis < 8; axis *= 2) {
            if (corner & axis) continue;
            glm::dvec2 low = projected.corners[corner], high = projected.corners[corner | axis];
            if (low.y > high.y) std::swap(low, high);
            const int first =
                int(std::ceil(std::clamp(low.y, double(firstRow), double(lastRow) + 1.0)));
            const int last =
                int(std::floor(std::clamp(high.y, double(firstRow) - 1.0, double(lastRow))));
            for (int y = first; y <= last; ++y) {
                glm::dvec2& span = spans[std::size_t(y - firstRow)];
                const double t = high.y > low.y ? (y - low.y) / (high.y - low.y) : 0.0;
                const double x = low.x + t * (high.x - low.x);
                // A level edge lies in its row from end to end.
                const double other = high.y > low.y ? x : high.x;
                span.x = std::min({span.x, x, other});
                span.y = std::max({span.y, x, other});
            }
        }
    for (int y = firstRow; y <= lastRow; ++y) {
        const glm::dvec2& span = spans[std::size_t(y - firstRow)];
        if (!(span.x <= _pixels.x - 1.0 && span.y >= 0.0)) continue;
        const int first = int(std::ceil(std::max(span.x, 0.0)));
        const int last = int(std::floor(std::min(span.y, _pixels.x - 1.0)));
        if (first > last) continue;
        for (int word = first / WORD; word <= last / WORD; ++word)
            row(y)[word] |= bitsOf(word, first, last);
    }
}

bool CoverMask::covers(const Box3d& box) const
{
    Projected projected;
    if (!project(box, projected)) return false;
    const glm::dvec2 least = glm::max(glm::floor(projected.min), 0.0);
    const glm::dvec2 most = glm::min(glm::ceil(projected.max), glm::dvec2(_pixels) - 1.0);
    if (!(least.x <= most.x && least.y <= most.y)) return false;
    const glm::ivec2 first(least), last(most);
    for (int y = first.y; y <= last.y; ++y)
        for (int word = first.x / WORD; word <= last.x / WORD; ++word)
            if (bitsOf(word, first.x, last.x) & ~row(y)[word]) return false;
    return true;
}

} // namespace core
} // namespace osgVolumizer
