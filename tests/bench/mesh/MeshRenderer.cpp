#include "MeshRenderer.h"

#ifdef OSGVOLUMIZER_MESH_CHART_VTK
#include "VtkMeshRenderer.h"
#endif

namespace osgVolumizer {
namespace bench {

MeshRendererPtr makeMeshRenderer(const std::string& name)
{
    if (name == "library") return makeLibraryMeshRenderer();
#ifdef OSGVOLUMIZER_MESH_CHART_VTK
    if (name == "projected") return makeVtkMeshRenderer(VtkMeshTechnique::PROJECTED);
    if (name == "preintegrated") return makeVtkMeshRenderer(VtkMeshTechnique::RAYS_PREINTEGRATED);
    if (name == "partial") return makeVtkMeshRenderer(VtkMeshTechnique::RAYS_PARTIAL);
    if (name == "linear") return makeVtkMeshRenderer(VtkMeshTechnique::RAYS_LINEAR);
#endif
    return nullptr;
}

} // namespace bench
} // namespace osgVolumizer
