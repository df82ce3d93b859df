#include "Renderer.h"

#ifdef OSGVOLUMIZER_CHART_VTK
#include "VtkRenderer.h"
#endif

#include <algorithm>

namespace osgVolumizer {
namespace bench {

RendererPtr makeRenderer(const std::string& name)
{
    const std::size_t colon = std::min(name.find(':'), name.size());
    const std::string kind = name.substr(0, colon);
    const std::string detail = colon < name.size() ? name.substr(colon + 1) : "";
    if (kind == "slabs" || kind == "slices" || kind == "apart" || kind == "tolerance" ||
        kind == "cells") {
        LibraryOptions options;
        options.slabs = kind != "slices";
        options.joined = kind != "apart";
        options.tolerance = kind == "tolerance";
        options.cells = kind == "cells";
        options.brickSize = detail.empty() ? 0 : std::stoi(detail);
        return makeLibraryRenderer(options);
    }
    if (kind == "bare") return makeBareRenderer();
    if (kind == "bareintegral") return makeBareRenderer(true);
    if (kind == "fixed") return makeOsgVolumeRenderer(OsgVolumeTechnique::FIXED_FUNCTION);
    if (kind == "raytraced") return makeOsgVolumeRenderer(OsgVolumeTechnique::RAY_TRACED);
    if (kind == "multipass") return makeOsgVolumeRenderer(OsgVolumeTechnique::MULTIPASS);
#ifdef OSGVOLUMIZER_CHART_VTK
    if (kind == "vtkgpu" || kind == "vtkcpu") return makeVtkRenderer(kind == "vtkgpu");
#endif
#ifdef OSGVOLUMIZER_CHART_VOLPACK
    if (kind == "volpack") return makeVolPackRenderer();
#endif
#ifdef OSGVOLUMIZER_CHART_OPENVDB
    if (kind == "openvdb") return makeOpenVdbRenderer();
#endif
    return nullptr;
}

} // namespace bench
} // namespace osgVolumizer
