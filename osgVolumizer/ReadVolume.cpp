#include "ReadVolume.h"

#include "VolumeGeometry.h"
#include "core/transfer/ScanStatistics.h"
#include "core/transfer/VisibleSphere.h"
#include "core/voxels/Preview.h"
#include "io/RawName.h"
#include "io/VoxelOptions.h"

#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <glm/matrix.hpp>

#include <cfloat>
#include <optional>

namespace osgVolumizer {

namespace {

constexpr double FRAME_TIME = 1.0 / 15.0; // seconds, while the view moves
constexpr double TIME_RATE = 10.0;        // steps a second
constexpr VolumeAppearance::Material MATERIAL{0.35, 0.95, 0.25, 24.0}; // brighter than the default
constexpr double SLICE_OPACITY = 8.0; // thickness of a slice, in opacity units
constexpr double SMOOTH = 1.5;        // see core::Preview::smoothness()

/// The table, looked for beside the volume as well.
Result<osg::ref_ptr<LookupTable>> readTable(const std::string& table, const std::string& volume,
                                            const osgDB::Options* options)
{
    std::string path = osgDB::findDataFile(volume, options);
    if (path.empty() && io::looksRaw(volume))
        if (const auto raw = io::parseRawName(volume); raw.ok())
            path = osgDB::findDataFile(raw->fileName, options);
    if (path.empty()) path = volume; // a pattern
    osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_back(osgDB::getFilePath(path));
    return readLookupTable(table, local.get());
}

core::ValueRange rangeOf(const Voxels& voxels)
{
    const osg::Vec2d range = voxels.getRange();
    return {range.x(), range.y()};
}

// Reads the finest level that is small, of the time step in the middle: a fire begins with nothing.
core::Preview previewOfPages(const Voxels& voxels)
{
    constexpr std::int64_t SMALL = std::int64_t(1) << 22; // samples
    const core::BrickTree& tree = voxels.getTree();
    int level = tree.levelCount() - 1;
    while (level > 0 && core::sampleCount(tree.levelSize(tree.size(), level - 1)) <= SMALL)
        --level;
    core::Preview preview(tree.levelSize(tree.size(), level), 1 << level);
    for (std::int64_t i = tree.index(level, glm::ivec3(0)), end = i + tree.brickCount(level);
         i < end; ++i) {
        const core::Box3i samples = tree.brick(i).samples;
        const Result<VoxelBlock> block = voxels.readPage(i, voxels.getStepCount() / 2);
        if (block.ok())
            preview.add({block->data, voxels.getType(), voxels.getComponents(), samples.size()},
                        samples.min);
        else
            reportError(block.status);
    }
    return preview;
}

// Reads all bricks; expects valid voxels.
core::Preview previewOf(const Voxels& voxels)
{
    if (voxels.isPaged()) return previewOfPages(voxels);
    core::Preview preview(voxels.getLayout().size());
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i) {
        const core::Box3i samples = voxels.getLayout().brick(i).samples;
        if (const Voxels::Block block = voxels.getBrick(i))
            preview.add({block.data, voxels.getType(), voxels.getComponents(), samples.size()},
                        samples.min);
    }
    return preview;
}

osg::ref_ptr<LookupTable> suggestedTable(const Voxels& voxels, const core::Preview& preview)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    core::ScanStatistics statistics(preview.view().size, rangeOf(voxels));
    statistics.add(preview.view());
    const core::TransferFunction suggested =
        core::suggestTransferFunction(statistics, preview.step());
    table->setPoints(suggested.points(), LookupTable::RANGE_FRACTION);
    return table;
}

Status setTable(VolumeAppearance& appearance, const io::VoxelOptions& said,
                const std::string& volume, const osgDB::Options* options,
                const core::Preview* preview)
{
    if (said.table) {
        const Result<osg::ref_ptr<LookupTable>> table = readTable(*said.table, volume, options);
        if (!table.ok()) return table.status;
        appearance.setLookupTable(table->get());
    } else if (said.ramp) {
        return appearance.getLookupTable()->setRamp(said.ramp->x, said.ramp->y, osg::Vec3(1, 1, 1),
                                                    said.ramp->z);
    } else if (preview) {
        appearance.setLookupTable(suggestedTable(*appearance.getVoxels(), *preview));
    }
    return {};
}

// The axis of one sample, as of a single slice; -1 where there is none.
int thinAxis(const Voxels& voxels)
{
    for (int axis : {2, 1, 0})
        if (voxels.getSize()[axis] == 1) return axis;
    return -1;
}

void setProperties(VolumeAppearance& appearance, const io::VoxelOptions& said,
                   const core::Preview* preview)
{
    const int thin = thinAxis(*appearance.getVoxels());
    if (thin >= 0 && !said.has("unit"))
        appearance.setOpacityUnit(appearance.getVoxels()->getSpacing()[thin] / SLICE_OPACITY);
    if (!said.has("frametime")) appearance.setTargetFrameTime(FRAME_TIME);
    if (appearance.getVoxels()->getStepCount() > 1 && !said.has("rate") && !said.has("step"))
        appearance.setTimeRate(TIME_RATE);
    if (!said.has("shading"))
        appearance.setShading(preview && thin < 0 && preview->smoothness() > SMOOTH);
    appearance.setMaterial(MATERIAL);
    for (const auto& [property, values] : said.properties)
        property->set(appearance, values);
}

// Where the voxel axes point: as was said, or as the file says; but a slice faces the viewer, whose
// home is at -y: columns to the right, rows down.
glm::dmat3 axesOf(const Voxels& voxels, const io::VoxelOptions& said)
{
    if (said.axes) return *said.axes;
    const int thin = said.axesOfFile ? -1 : thinAxis(voxels);
    if (thin < 0) return voxels.getSource()->describe().axes;
    glm::dmat3 axes(0.0);
    axes[(thin + 1) % 3].x = 1.0;
    axes[(thin + 2) % 3].z = -1.0;
    axes[thin].y = 1.0;
    return axes;
}

// Voxels whose axes are said to point elsewhere begin where the file says.
Status keepFirstSample(Voxels& voxels, io::VoxelOptions said)
{
    if (!said.axes || said.origin) return {};
    const VoxelSource::Description d = voxels.getSource()->describe();
    const glm::dvec3 origin = glm::transpose(*said.axes) * (d.axes * d.origin);
    if (origin == d.origin) return {};
    Status status = voxels.setOrigin(osg::Vec3d(origin.x, origin.y, origin.z));
    said.origin = origin;
    voxels.setFileOptions(said.voxelText());
    return status;
}

osg::Matrixd turn(const glm::dmat3& axes)
{
    // OSG multiplies rows: row i is where axis i points.
    return {axes[0].x, axes[0].y, axes[0].z, 0, axes[1].x, axes[1].y, axes[1].z, 0,
            axes[2].x, axes[2].y, axes[2].z, 0, 0,         0,         0,         1};
}

// The sphere that viewers are to frame, in the frame of the box.
osg::BoundingSphere framed(const VolumeAppearance& appearance, const osg::BoundingSphere& box,
                           const core::Preview& preview)
{
    const Voxels& voxels = *appearance.getVoxels();
    const osg::Vec3d spacing = voxels.getSpacing();
    const osg::Vec2d range = voxels.getRange();
    const std::optional<core::BoundingSphere> sphere = core::visibleSphere(
        preview.view(), rangeOf(voxels), *appearance.getLookupTable()->getNormalizedFunction(range),
        double(preview.step()) * glm::dvec3(spacing.x(), spacing.y(), spacing.z()));
    if (!sphere || !(sphere->radius < box.radius())) return box;
    const glm::dvec3& c = sphere->center;
    return {osg::Vec3(osg::Vec3d(c.x, c.y, c.z) + voxels.getOrigin()),
            static_cast<float>(sphere->radius)};
}

osg::ref_ptr<osg::Node> placed(const VolumeAppearance& appearance, const glm::dmat3& axes,
                               const core::Preview* preview)
{
    const osg::ref_ptr<VolumeGeometry> box = VolumeGeometry::createBox(*appearance.getVoxels());
    osg::ref_ptr<osg::Node> node = box;
    const osg::Matrixd matrix = turn(axes);
    if (!matrix.isIdentity()) {
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
        transform->setName("upright");
        transform->setDataVariance(osg::Object::STATIC);
        transform->addChild(box);
        node = transform;
    }
    if (!preview) return node;
    const osg::BoundingSphere sphere = framed(appearance, box->getBound(), *preview);
    osg::ref_ptr<osg::LOD> frame = new osg::LOD;
    frame->setName("framed by what shows");
    frame->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    frame->setCenter(osg::Vec3d(sphere.center()) * matrix);
    frame->setRadius(sphere.radius());
    frame->addChild(node, 0.0f, FLT_MAX);
    frame->setCullingActive(false); // of the sphere: the volume reaches beyond it
    return frame;
}

} // namespace

osg::Matrixd getPlacement(const Voxels& voxels)
{
    return voxels.valid() ? turn(voxels.getSource()->describe().axes) : osg::Matrixd();
}

osg::ref_ptr<LookupTable> createSuggestedTable(const Voxels& voxels)
{
    if (!voxels.valid() || voxels.getComponents() != 1) return new LookupTable;
    return suggestedTable(voxels, previewOf(voxels));
}

std::vector<VolumeOption> volumeOptions()
{
    return io::voxelOptionHelp();
}

Result<osg::ref_ptr<VolumeAppearance>>
readVolume(const std::string& name, const osgDB::Options* options, const Progress& progress)
{
    const Result<osg::ref_ptr<Voxels>> voxels = readVoxels(name, options, progress);
    if (!voxels.ok()) return voxels.status;
    // Parsed before, by readVoxels().
    const io::VoxelOptions said =
        *io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setName(osgDB::getSimpleFileName(name));
    appearance->setVoxels(voxels->get());
    if (Status status = keepFirstSample(**voxels, said); !status.ok()) return status;
    std::optional<core::Preview> preview;
    if ((*voxels)->getComponents() == 1) preview = previewOf(**voxels);
    const core::Preview* p = preview ? &*preview : nullptr;
    const CallerReports quiet;
    if (Status status = setTable(*appearance, said, name, options, p); !status.ok()) return status;
    setProperties(*appearance, said, p);
    appearance->addChild(placed(*appearance, axesOf(**voxels, said), p));
    return appearance;
}

} // namespace osgVolumizer
