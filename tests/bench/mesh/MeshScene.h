#pragma once

#include "../support/Tables.h"

#include <oracles/TetraMesh.h>
#include <support/SceneRenderer.h>

namespace osgVolumizer {
namespace bench {

/// A mesh with a scalar per point, one table over the scalars [0, 1], and a view that goes round
/// it. World = object frame.
struct MeshScene
{
    std::string name;
    std::string description;
    oracle::TetraMesh mesh;
    TablePoints table;
    double unit = 1.0; ///< opacity unit, object units
    bool orthographic = false;

    /// 512 x 512 pixels; each view is a degree further round than the one before.
    support::RenderOptions view(int number) const;
};

/// The scenes' names, in order.
std::vector<std::string> meshSceneNames();
/// A unit cube of n^3 hexahedra, each cut into five tetrahedra, with its inner points moved about.
/// Of no cells for an unknown name.
MeshScene makeMeshScene(const std::string& name, int n);

} // namespace bench
} // namespace osgVolumizer
