#include "Renderer.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <support/Hooks.h>

namespace osgVolumizer {
namespace bench {

namespace {

/// osgVolumizer as an application uses it: a whole frame of osgViewer, update to swap.
class LibraryRenderer : public Renderer
{
public:
    LibraryRenderer(const LibraryOptions& options) : _options(options) {}

    std::string name() const override
    {
        std::string name = _options.slabs ? "osgVolumizer slabs" : "osgVolumizer slices";
        if (_options.brickSize) name += " bricks " + std::to_string(_options.brickSize);
        if (!_options.joined) name += " apart";
        if (_options.tolerance) name += " tolerance";
        return name;
    }

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
        if (status.ok() && _options.brickSize)
            status =
                voxels->setBrickSize({_options.brickSize, _options.brickSize, _options.brickSize});
        if (!status.ok()) return status;
        osg::ref_ptr<LookupTable> table = new LookupTable;
        status = table->setPoints(scene.table, LookupTable::RANGE_FRACTION);
        if (!status.ok()) return status;

        _appearance = new VolumeAppearance;
        _appearance->setVoxels(voxels);
        _appearance->setLookupTable(table);
        _appearance->setTechnique(_options.slabs ? VolumeAppearance::SLABS
                                                 : VolumeAppearance::SLICES);
        _appearance->addChild(VolumeGeometry::createBox(*voxels));
        _appearance->setShading(scene.shaded);
        support::RenderOptions options = scene.view;
        options.light = scene.shaded;
        _renderer = std::make_unique<support::SceneRenderer>(
            _appearance, support::joining(options, _options.joined));
        _renderer->viewer().getCamera()->getStats()->collectStats("rendering", true);
        _renderer->viewer().getViewerStats()->collectStats("update", true);
        return _renderer->status();
    }
    Status setStep(double stepVoxel) override
    {
        if (_options.tolerance) return _appearance->setErrorTolerance(1e-3 * stepVoxel);
        return _appearance->setSamplingPeriod(osg::Vec3d(stepVoxel, stepVoxel, stepVoxel));
    }
    void frame() override { _renderer->viewer().frame(); }
    support::FloatImage picture() override { return _renderer->render(); }
    std::map<std::string, double> split() override
    {
        std::map<std::string, double> result = _renderer->counters();
        osgViewer::Viewer& viewer = _renderer->viewer();
        const unsigned frame = viewer.getFrameStamp()->getFrameNumber();
        const auto add = [&](osg::Stats* stats, const std::string& key) {
            double seconds = 0.0;
            if (stats->getAttribute(frame, key, seconds)) result[key + ", ms"] = 1e3 * seconds;
        };
        add(viewer.getViewerStats(), "Update traversal time taken");
        add(viewer.getCamera()->getStats(), "Cull traversal time taken");
        add(viewer.getCamera()->getStats(), "Draw traversal time taken");
        return result;
    }

private:
    LibraryOptions _options;
    std::vector<unsigned char> _data;
    osg::ref_ptr<VolumeAppearance> _appearance;
    std::unique_ptr<support::SceneRenderer> _renderer;
};

} // namespace

RendererPtr makeLibraryRenderer(const LibraryOptions& options)
{
    return std::make_unique<LibraryRenderer>(options);
}

} // namespace bench
} // namespace osgVolumizer
