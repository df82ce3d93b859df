#pragma once

#include "Scene.h"

#include <vector>

namespace osgVolumizer {
namespace oracle {

/// The triangles of a scene by the tiles of the window that they may cover. Leaves out only what no
/// ray of a tile can hit; whether one does is not decided here.
class ScreenTriangles
{
public:
    using List = std::vector<const Triangle*>;

    /// Keeps pointers into the scene.
    ScreenTriangles(const Scene& scene, const Camera& camera);

    /// Those that the ray through window position (x, y) may hit, in the scene's order.
    const List& at(double x, double y) const;

private:
    static constexpr int TILE = 16; ///< pixels

    int _width, _height; ///< window, pixels
    int _columns, _rows; ///< tiles
    List _all;
    std::vector<List> _tiles;
};

} // namespace oracle
} // namespace osgVolumizer
