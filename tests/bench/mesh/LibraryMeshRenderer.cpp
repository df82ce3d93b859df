#include "MeshRenderer.h"

#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <oracles/TestMeshes.h>

namespace osgVolumizer {
namespace bench {

namespace {

/// osgVolumizer as an application uses it: a whole frame of osgViewer, update to swap.
class LibraryMeshRenderer : public MeshRenderer
{
public:
    std::string name() const override { return "osgVolumizer"; }

    Status open(const MeshScene& scene) override
    {
        const osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
        Status status = geometry->setTetraSet(oracle::tetraSet(scene.mesh));
        if (!status.ok()) return status;
        status = geometry->setScalars({scene.mesh.scalars.begin(), scene.mesh.scalars.end()});
        if (status.ok()) status = geometry->setScalarRange(osg::Vec2d(0.0, 1.0));
        if (!status.ok()) return status;

        const osg::ref_ptr<LookupTable> table = new LookupTable;
        status = table->setPoints(scene.table, LookupTable::RANGE_FRACTION);
        if (!status.ok()) return status;
        const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        appearance->setLookupTable(table);
        status = appearance->setOpacityUnit(scene.unit);
        appearance->addChild(geometry);
        if (!status.ok()) return status;
        _renderer = std::make_unique<support::SceneRenderer>(appearance, scene.view(0));
        return _renderer->status();
    }
    void setView(const support::RenderOptions& view) override
    {
        _renderer->options() = view;
        osg::Camera* camera = _renderer->viewer().getCamera();
        camera->setViewMatrix(view.view);
        camera->setProjectionMatrix(view.projection);
    }
    void frame() override { _renderer->viewer().frame(); }
    support::FloatImage picture() override { return _renderer->render(); }

private:
    std::unique_ptr<support::SceneRenderer> _renderer;
};

} // namespace

MeshRendererPtr makeLibraryMeshRenderer()
{
    return std::make_unique<LibraryMeshRenderer>();
}

} // namespace bench
} // namespace osgVolumizer
