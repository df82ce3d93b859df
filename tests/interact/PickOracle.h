#pragma once

// Where a volume is seen, by dense sampling in double precision and none of the library's code.

#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/interact/Pick.h>

#include <render/Volumes.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

namespace osgVolumizer {
namespace test {

struct Line
{
    glm::dvec3 start, end;

    double length() const { return glm::length(end - start); }
    glm::dvec3 at(double ratio) const { return start + ratio * (end - start); }
};

inline osg::Vec3d toVec3d(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}
inline glm::dvec3 toDvec3(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Lines through random points of a box, from outside of it.
class RandomLines
{
public:
    RandomLines(const glm::dvec3& low, const glm::dvec3& high, unsigned seed = 1)
        : _low(low), _high(high), _random(seed)
    {
    }
    Line next()
    {
        const glm::dvec3 through = point(), direction = glm::normalize(point() - point());
        const double reach = glm::length(_high - _low);
        return {through - reach * direction, through + reach * direction};
    }
    glm::dvec3 point()
    {
        std::uniform_real_distribution<double> u(0.0, 1.0);
        glm::dvec3 p;
        for (int a = 0; a < 3; ++a)
            p[a] = _low[a] + u(_random) * (_high[a] - _low[a]);
        return p;
    }

private:
    glm::dvec3 _low, _high;
    std::mt19937 _random;
};

/// Extinction per object unit at a place of the object frame; 0 outside.
using Extinction = std::function<double(const glm::dvec3& object)>;

/// What a dense march finds.
struct DenseHit
{
    std::optional<double> ratio; ///< where the opacity reaches the threshold
    double opacity = 0.0;        ///< of all of the line
    std::vector<double> depths;  ///< optical, up to each step's end

    double opacityAt(double at) const
    {
        const double place = at * static_cast<double>(depths.size());
        const std::size_t i = std::min(static_cast<std::size_t>(place), depths.size() - 1);
        const double before = i > 0 ? depths[i - 1] : 0.0;
        return -std::expm1(-(before + (place - double(i)) * (depths[i] - before)));
    }
};

/// \param step object units
inline DenseHit denseHit(const Extinction& extinction, const Line& line, double threshold,
                         double step)
{
    DenseHit hit;
    const double enough = -std::log1p(-threshold);
    const int count = static_cast<int>(std::ceil(line.length() / step));
    const double h = line.length() / count;
    double depth = 0.0;
    for (int i = 0; i < count; ++i) {
        const double added = h * extinction(line.at((i + 0.5) / count));
        if (!hit.ratio && depth + added >= enough)
            hit.ratio = (i + (enough - depth) / added) / count;
        depth += added;
        hit.depths.push_back(depth);
    }
    hit.opacity = -std::expm1(-depth);
    return hit;
}

inline bool inside(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high)
{
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
}

/// The geometry below an appearance that makeVolume() made.
inline VolumeGeometry& geometryBelow(VolumeAppearance& appearance)
{
    return *dynamic_cast<VolumeGeometry*>(appearance.getChild(0));
}

inline std::optional<PickHit> pickLine(VolumeAppearance& appearance, const Line& line)
{
    const auto found =
        pickVolume(geometryBelow(appearance), appearance, toVec3d(line.start), toVec3d(line.end));
    EXPECT_TRUE(found.ok()) << found.status.text;
    return *found;
}

/// Picks along random lines through a box of the object frame and compares with the dense march:
/// all hits to `tolerance` (object units), and a hit wherever the opacity is not within a hundredth
/// of the threshold. Where hardly anything is added about the threshold, of which there may be one
/// line in 200, the opacity has to be that to 2e-4. \return how many lines hit
inline int comparePicks(VolumeAppearance& appearance, const Extinction& extinction,
                        const glm::dvec3& low, const glm::dvec3& high, int lines, double tolerance,
                        double step)
{
    RandomLines random(low, high);
    const double threshold = appearance.getPickOpacity();
    int hits = 0, vague = 0;
    for (int i = 0; i < lines; ++i) {
        const Line line = random.next();
        const DenseHit dense = denseHit(extinction, line, threshold, step);
        const auto found = pickLine(appearance, line);
        const bool graze = std::fabs(dense.opacity - threshold) < 0.01;
        if (found.has_value() != dense.ratio.has_value()) {
            EXPECT_TRUE(graze) << "line " << i << ", opacity " << dense.opacity;
            continue;
        }
        if (!found || graze) continue;
        ++hits;
        const double off = std::fabs(found->ratio - *dense.ratio) * line.length();
        if (off <= tolerance) continue;
        ++vague;
        const DenseHit denser = denseHit(extinction, line, threshold, step / 64.0);
        EXPECT_LT(std::fabs(denser.opacityAt(found->ratio) - threshold), 3e-4)
            << "line " << i << " is off by " << off;
    }
    EXPECT_LE(vague, lines / 200);
    return hits;
}

} // namespace test
} // namespace osgVolumizer
