#include "Renderer.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

namespace osgVolumizer {
namespace bench {

namespace {

/// osgVolumizer as an application uses it: a whole frame of osgViewer, update to swap.
class LibraryRenderer : public Renderer
{
public:
    explicit LibraryRenderer(bool slabs) : _slabs(slabs) {}

    std::string name() const override { return _slabs ? "osgVolumizer slabs" : "osgVolumizer slices"; }

    Status open(const ChartScene& scene) override
    {
        VoxelSource::Description description;
        description.size = scene.size;
        description.type = scene.type;
        description.origin = scene.origin;
        _data = scene.voxels;
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        Status status = source->setExternal(description, _data.data());
        if (!status.ok()) return status;
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        status = voxels->setRange(osg::Vec2d(scene.range.x, scene.range.y));
        if (!status.ok()) return status;
        osg::ref_ptr<LookupTable> table = new LookupTable;
        status = table->setPoints(scene.table, LookupTable::RANGE_FRACTION);
        if (!status.ok()) return status;

        _appearance = new VolumeAppearance;
        _appearance->setVoxels(voxels);
        _appearance->setLookupTable(table);
        _appearance->setTechnique(_slabs ? VolumeAppearance::SLABS : VolumeAppearance::SLICES);
        _appearance->addChild(VolumeGeometry::createBox(*voxels));
        if (scene.shaded) return Status(ErrorCode::NOT_SUPPORTED, "no shading yet");
        _renderer = std::make_unique<support::SceneRenderer>(_appearance, scene.view);
        return _renderer->status();
    }
    Status setStep(double stepVoxel) override
    {
        return _appearance->setSamplingPeriod(osg::Vec3d(stepVoxel, stepVoxel, stepVoxel));
    }
    void frame() override { _renderer->viewer().frame(); }
    support::FloatImage picture() override { return _renderer->render(); }

private:
    bool _slabs;
    std::vector<unsigned char> _data;
    osg::ref_ptr<VolumeAppearance> _appearance;
    std::unique_ptr<support::SceneRenderer> _renderer;
};

} // namespace

RendererPtr makeLibraryRenderer(bool slabs)
{
    return std::make_unique<LibraryRenderer>(slabs);
}

} // namespace bench
} // namespace osgVolumizer
