// What the nodes call in the renderer.
#include "../../private/Renderer.h"

#include "../context/ContextResources.h"
#include "../context/SharedStateSets.h"
#include "../volume/GeometryCache.h"
#include "../volume/SettingsInForce.h"
#include "Cull.h"
#include "CullSection.h"
#include "TableChoice.h"

#include "../../VolumeGeometry.h"

namespace osgVolumizer {
namespace render {

namespace {

class VolumeRenderer : public Renderer
{
public:
    void cull(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor) override
    {
        render::cull(geometry, visitor);
    }
    void cull(VolumeSlice& slice, osgUtil::CullVisitor& visitor) override
    {
        cullSection(slice, visitor);
    }
    void resizeGLObjectBuffers(unsigned int maximum) override { resizeSharedStateSets(maximum); }
    void releaseGLObjects(osg::State* state) override { releaseContextResources(state); }
    VolumeAppearance::Settings settingsInForce(const VolumeAppearance& appearance,
                                               const VolumeGeometry& geometry) override
    {
        const Voxels* voxels = appearance.getVoxels();
        const bool drawn = !voxels || voxels->valid();
        const auto prepared =
            drawn ? renderData<GeometryCache>(geometry)->get(geometry, voxels) : nullptr;
        if (!prepared) {
            VolumeAppearance::Settings settings;
            settings.reasons.emplace_back("the volume is empty; nothing is drawn");
            return settings;
        }
        voxels = voxelsIn(appearance, *prepared);
        const TableChoice choice =
            voxels ? chooseTable(appearance, *prepared, leastPrecision()) : TableChoice();
        VolumeAppearance::Settings settings = render::settingsInForce(
            appearance, *prepared, choice.table.lookup(), choice.exactFiltering, choice.adaptive);
        settings.expectedError = choice.expectedError;
        settings.refining = choice.refining;
        explainError(appearance.getErrorTolerance(), choice.expectedError, settings.reasons);
        return settings;
    }
};

// Never destroyed: nodes may be, after everything static.
[[maybe_unused]] const bool installed = [] {
    setRenderer(new VolumeRenderer);
    return true;
}();

} // namespace

} // namespace render
} // namespace osgVolumizer
