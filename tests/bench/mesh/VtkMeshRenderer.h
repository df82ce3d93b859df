#pragma once

#include "MeshRenderer.h"

namespace osgVolumizer {
namespace bench {

enum class VtkMeshTechnique
{
    /// vtkProjectedTetrahedraMapper: Shirley and Tuchman, "A polygonal approximation to direct
    /// scalar volume rendering", 1990. Cells are sorted by their centres on the CPU.
    PROJECTED,
    /// vtkUnstructuredGridVolumeRayCastMapper, on the CPU in as many threads as there are cores
    /// (Bunyk et al., "Simple, fast, and robust ray casting of irregular grids", 1997), with the
    /// integrator that it chooses itself: a table over both ends and the length of a segment.
    RAYS_PREINTEGRATED,
    /// The same with vtkUnstructuredGridPartialPreIntegration: linear pieces, a table of two
    /// optical depths.
    RAYS_PARTIAL,
    /// The same with vtkUnstructuredGridLinearRayIntegrator: linear pieces in closed form.
    RAYS_LINEAR
};

/// VTK's renderers of tetrahedra. Their colours pass through 8 bits: those of vertices, or those of
/// the picture. They need an X server (Xvfb will do).
MeshRendererPtr makeVtkMeshRenderer(VtkMeshTechnique technique);

} // namespace bench
} // namespace osgVolumizer
