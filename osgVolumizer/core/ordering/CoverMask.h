#pragma once

#include "../Export.h"
#include "../geometry/Box.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Which pixels of a view are covered by boxes. Of a pixel its centre counts, where its ray runs;
/// so boxes that share a face leave no gap.
class OSGVOLUMIZER_CORE_EXPORT CoverMask
{
public:
    /// \param toClip from the frame of the boxes to clip space, -w <= z <= w \param pixels of the
    /// view, each >= 1
    CoverMask(const glm::dmat4& toClip, const glm::ivec2& pixels);

    /// Covers the pixels whose rays meet a box. Nothing where a part of it lies before the near
    /// plane.
    void add(const Box3d& box);
    /// Whether all pixels of the rectangle around a box are covered; false where a part of it lies
    /// before the near plane, and where there are no pixels.
    bool covers(const Box3d& box) const;

private:
    struct Projected;

    bool project(const Box3d& box, Projected& projected) const;
    std::uint64_t* row(int y) { return &_bits[std::size_t(y) * _words]; }
    const std::uint64_t* row(int y) const { return &_bits[std::size_t(y) * _words]; }

    glm::dmat4 _toClip;
    glm::ivec2 _pixels;
    std::size_t _words = 0; ///< of a row
    std::vector<std::uint64_t> _bits;
};

} // namespace core
} // namespace osgVolumizer
