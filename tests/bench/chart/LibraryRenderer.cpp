#include "Renderer.h"

#include "MixedScene.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <support/Choices.h>
#include <support/Hooks.h>

namespace osgVolumizer {
namespace bench {

namespace {

constexpr double FINEST = 1.0 / 32.0; // step, voxels

/// osgVolumizer as an application uses it: a whole frame of osgViewer, update to swap.
class LibraryRenderer : public Renderer
{
public:
    LibraryRenderer(const LibraryOptions& options) : _options(options) {}

    std::string name() const override
    {
        if (_options.tolerance) return "osgVolumizer, error asked for";
        std::string name = _options.slabs ? "osgVolumizer slabs" : "osgVolumizer slices";
        if (_options.brickSize) name += " bricks " + std::to_string(_options.brickSize);
        if (!_options.joined) name += " apart";
        if (_options.cells) name += " cell by cell";
        return name;
    }

    Status open(const ChartScene& scene) override
    {
        _scene = scene;
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        for (ChartVolume& volume : _scene.volumes) {
            const Status status = addVolume(volume, *root);
            if (!status.ok()) return status;
        }
        for (const ChartSurface& surface : scene.surfaces)
            root->addChild(test::makeGeometry(surface.mesh, surface.color));
        support::RenderOptions options = scene.view;
        options.light = scene.shaded;
        _renderer = std::make_unique<support::SceneRenderer>(
            root, support::joining(options, _options.joined));
        _renderer->viewer().getCamera()->getStats()->collectStats("rendering", true);
        _renderer->viewer().getViewerStats()->collectStats("update", true);
        return _renderer->status();
    }
    Status setStep(double stepVoxel) override
    {
        Status status;
        for (const auto& appearance : _appearances) {
            appearance->setLookup(_options.cells ? VolumeAppearance::CELL_BY_CELL
                                                 : VolumeAppearance::AUTOMATIC_LOOKUP);
            status =
                _options.tolerance
                    ? appearance->setErrorTolerance(1e-3 * stepVoxel)
                    : appearance->setSamplingPeriod(osg::Vec3d(stepVoxel, stepVoxel, stepVoxel));
            if (!status.ok()) return status;
            if (_options.tolerance && !support::waitForChoice(*appearance))
                return Status(ErrorCode::NOT_SUPPORTED, "no sampling was chosen");
        }
        return status;
    }
    // By steps, whatever is measured.
    Status setFinest() override
    {
        Status status;
        for (const auto& appearance : _appearances) {
            appearance->setLookup(VolumeAppearance::AFTER_INTERPOLATION);
            status = appearance->setErrorTolerance(0.0);
            if (status.ok())
                status = appearance->setSamplingPeriod(osg::Vec3d(FINEST, FINEST, FINEST));
            if (!status.ok()) return status;
        }
        return status;
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
    Status addVolume(ChartVolume& volume, osg::Group& root)
    {
        VoxelSource::Description description;
        description.size = volume.size;
        description.type = volume.type;
        description.origin = volume.origin;
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        Status status = source->setExternal(description, volume.voxels.data());
        if (!status.ok()) return status;
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        status = voxels->setRange(osg::Vec2d(volume.range.x, volume.range.y));
        if (status.ok() && _options.brickSize)
            status =
                voxels->setBrickSize({_options.brickSize, _options.brickSize, _options.brickSize});
        if (!status.ok()) return status;
        osg::ref_ptr<LookupTable> table = new LookupTable;
        status = table->setPoints(volume.table, LookupTable::RANGE_FRACTION);
        if (!status.ok()) return status;

        const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        appearance->setVoxels(voxels);
        appearance->setLookupTable(table);
        appearance->setTechnique(_options.slabs ? VolumeAppearance::SLABS
                                                : VolumeAppearance::SLICES);
        appearance->addChild(VolumeGeometry::createBox(*voxels));
        appearance->setShading(_scene.shaded);
        appearance->setGradients(VolumeAppearance::PRECOMPUTED);
        root.addChild(appearance);
        _appearances.push_back(appearance);
        return status;
    }

    LibraryOptions _options;
    ChartScene _scene; ///< whose voxels the sources look at
    std::vector<osg::ref_ptr<VolumeAppearance>> _appearances;
    std::unique_ptr<support::SceneRenderer> _renderer;
};

} // namespace

RendererPtr makeLibraryRenderer(const LibraryOptions& options)
{
    return std::make_unique<LibraryRenderer>(options);
}

} // namespace bench
} // namespace osgVolumizer
