#include "Voxels.h"

#include "Error.h"
#include "core/NumberRule.h"
#include "core/Text.h"
#include "core/voxels/VoxelData.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <set>

#include <sys/mman.h>

namespace osgVolumizer {

struct Voxels::Brick
{
    std::mutex mutex; // held while the source reads, so that a brick is read once
    core::ValueRange range;
    bool rangeKnown = false;
    bool failed = false;
    unsigned modified = 0;           // set before the brick is shared
    std::vector<core::Box3i> unseen; // samples that may have values beyond the range
};

namespace {

bool holds(const core::NumberRule& rule, const osg::Vec3d& v)
{
    return rule.holds(v.x()) && rule.holds(v.y()) && rule.holds(v.z());
}

ReportedStatus refuse(const char* what, const osg::Vec3d& v, const core::NumberRule& rule)
{
    return reported(
        {ErrorCode::VALUE_INVALID, what + core::formatTriple(glm::dvec3(v.x(), v.y(), v.z())) +
                                       ", expected each to be " + rule.expected});
}

osg::Vec3i toOsg(const glm::ivec3& v)
{
    return {v.x, v.y, v.z};
}

// Bricks of many kilobytes come and go by the thousand, in any order: the heap would be left full
// of holes between them, so they are the system's, which gets them back at once.
std::shared_ptr<unsigned char> allocateBrick(std::size_t bytes)
{
    constexpr std::size_t MANY = 64 << 10;
    if (bytes < MANY) return {new unsigned char[bytes], std::default_delete<unsigned char[]>()};
    void* memory =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return {static_cast<unsigned char*>(memory),
            [bytes](unsigned char* brick) { ::munmap(brick, bytes); }};
}

unsigned nextLayoutCount()
{
    static std::atomic<unsigned> last{0};
    return ++last;
}

/// The component that lookup tables, ranges and emptiness refer to.
int significantComponent(const VoxelSource::Description& d)
{
    return d.components == 4 ? 3 : 0;
}

// Paged voxels are drawn from their pages, which have no partial ones.
Result<core::BrickLayout> makeLayout(const glm::ivec3& size, const glm::ivec3& brickSize,
                                     int overlap, core::PartialBricks partial,
                                     const core::BrickTree& tree)
{
    const Result<core::BrickLayout> layout =
        core::BrickLayout::create(size, brickSize, overlap, partial);
    if (!layout.ok() || tree.levelCount() == 0) return layout;
    return core::BrickLayout::create(size, brickSize, overlap);
}

} // namespace

Voxels::Voxels() : _layoutCount(nextLayoutCount()) {}

Voxels::Voxels(VoxelSource* source) : Voxels()
{
    setSource(source);
}

Voxels::Voxels(const Voxels& o, const osg::CopyOp& op)
    : osg::Object(o, op),
      _source(dynamic_cast<VoxelSource*>(op(static_cast<const osg::Object*>(o._source.get())))),
      _description(o._description), _brickSize(o._brickSize), _partialBricks(o._partialBricks),
      _overlap(o._overlap), _layout(o._layout), _tree(o._tree), _stepCount(o._stepCount),
      _textureBudget(o._textureBudget), _fileName(o._fileName), _filePath(o._filePath),
      _fileOptions(o._fileOptions), _layoutCount(nextLayoutCount())
{
    std::lock_guard<std::mutex> lock(o._rangeMutex);
    _explicitRange = o._explicitRange;
    _rangeKnown = o._rangeKnown;
    _range = o._range;
}

Voxels::~Voxels() = default;

ReportedStatus Voxels::setSource(VoxelSource* source)
{
    osg::ref_ptr<VoxelSource> keep(source);
    VoxelSource::Description description;
    core::BrickLayout layout;
    core::BrickTree tree;
    if (source) {
        description = source->describe();
        if (Status status = description.validate(); !status.ok())
            return reported(std::move(status));
        if (Status status = makeTree(source, _overlap, tree); !status.ok())
            return reported(std::move(status));
        const Result<core::BrickLayout> made =
            makeLayout(description.size, _brickSize, _overlap, _partialBricks, tree);
        if (!made.ok()) return reported(made.status);
        layout = *made;
    }
    _source = keep;
    _description = description;
    _layout = layout;
    _tree = tree;
    _stepCount = source ? std::max(source->stepCount(), 1) : 1;
    {
        std::lock_guard<std::mutex> lock(_rangeMutex);
        double low = 0.0, high = 1.0;
        voxelTypeRange(description.type, low, high);
        _range.set(low, high);
        _explicitRange = false;
        _rangeKnown =
            !source || description.components != 1 || voxelTypeSize(description.type) == 1;
    }
    forgetBricks();
    if (isPaged()) getRange();
    return {};
}

ReportedStatus Voxels::exchangeSource(VoxelSource* source)
{
    if (!source || !valid())
        return reported({ErrorCode::VALUE_INVALID, "there is no voxel source to exchange"});
    const osg::ref_ptr<VoxelSource> keep(source);
    const VoxelSource::Description d = source->describe();
    if (d.size != _description.size || d.type != _description.type ||
        d.components != _description.components || source->levelCount() != _source->levelCount() ||
        source->stepCount() != _source->stepCount() || source->pageSize() != _source->pageSize())
        return reported(
            {ErrorCode::SIZE_MISMATCH, "a voxel source of " + core::formatTriple(d.size) +
                                           " voxels cannot stand for one of " +
                                           core::formatTriple(_description.size) +
                                           " with another type, size, levels or time steps"});
    _source = keep;
    return {};
}

bool Voxels::valid() const
{
    return _source.valid();
}

osg::Vec3i Voxels::getSize() const
{
    return toOsg(_description.size);
}

osg::Vec3i Voxels::getBrickSize() const
{
    return toOsg(_brickSize);
}

ReportedStatus Voxels::setSpacing(const osg::Vec3d& spacing)
{
    if (!holds(core::LENGTH, spacing)) return refuse("voxel spacing is ", spacing, core::LENGTH);
    _description.spacing = glm::dvec3(spacing.x(), spacing.y(), spacing.z());
    _layoutCount = nextLayoutCount();
    return {};
}

osg::Vec3d Voxels::getSpacing() const
{
    return {_description.spacing.x, _description.spacing.y, _description.spacing.z};
}

ReportedStatus Voxels::setOrigin(const osg::Vec3d& origin)
{
    if (!holds(core::POSITION, origin)) return refuse("volume origin is ", origin, core::POSITION);
    _description.origin = glm::dvec3(origin.x(), origin.y(), origin.z());
    _layoutCount = nextLayoutCount();
    return {};
}

osg::Vec3d Voxels::getOrigin() const
{
    return {_description.origin.x, _description.origin.y, _description.origin.z};
}

double Voxels::getMeanSpacing() const
{
    return (_description.spacing.x + _description.spacing.y + _description.spacing.z) / 3.0;
}

ReportedStatus Voxels::setRange(const osg::Vec2d& range)
{
    if (!core::RANGE_WIDTH.holds(range.y() - range.x()))
        return reported({ErrorCode::VALUE_INVALID,
                         "value range is " + core::formatNumber(range.x()) + "," +
                             core::formatNumber(range.y()) + ", expected it to rise, over " +
                             core::RANGE_WIDTH.expected});
    std::lock_guard<std::mutex> lock(_rangeMutex);
    _range = range;
    _rangeKnown = _explicitRange = true;
    _layoutCount = nextLayoutCount();
    return {};
}

osg::Vec2d Voxels::getRange() const
{
    std::lock_guard<std::mutex> lock(_rangeMutex);
    if (!_rangeKnown) findRange();
    return _range;
}

bool Voxels::hasExplicitRange() const
{
    std::lock_guard<std::mutex> lock(_rangeMutex);
    return _explicitRange;
}

// No tree for a source that has only the volume, once.
Status Voxels::makeTree(const VoxelSource* source, int overlap, core::BrickTree& tree) const
{
    tree = {};
    const int levels = source ? source->levelCount() : 1;
    if (levels <= 1 && !(source && source->stepCount() > 1)) return {};
    Result<core::BrickTree> made = core::BrickTree::create(
        source->describe().size, std::max(levels, 1), source->pageSize(), overlap);
    if (made.ok()) tree = *made;
    return made.status;
}

ReportedStatus Voxels::setTextureBudget(std::int64_t bytes)
{
    constexpr std::int64_t LEAST = std::int64_t(1) << 20;
    if (bytes != 0 && bytes < LEAST)
        return reported(
            {ErrorCode::VALUE_INVALID, "texture budget of voxels is " + std::to_string(bytes) +
                                           " bytes, expected 0, or a megabyte or more"});
    _textureBudget = bytes;
    return {};
}

Result<VoxelBlock> Voxels::readPage(std::int64_t page, int step) const
{
    const core::TreeBrick brick = _tree.brick(page);
    Status status;
    bool shared = false;
    ++_readCount;
    Block block = readBrick(step, brick.level, brick.samples, shared, status);
    if (status.ok()) return block;
    status.text = (_stepCount > 1 ? "time step " + std::to_string(step) + ", " : "") + "level " +
                  std::to_string(brick.level) + ", brick " + core::formatTriple(brick.coordinates) +
                  (_fileName.empty() ? "" : " of " + _fileName) + ": " + status.text;
    return status;
}

std::optional<std::pair<double, double>> Voxels::getPageRange(std::int64_t page, int step) const
{
    return getPageRange(_tree.brick(page), step);
}

std::optional<std::pair<double, double>> Voxels::getPageRange(const core::TreeBrick& page,
                                                              int step) const
{
    return knownRange(step, page.level, page.samples);
}

std::optional<std::pair<double, double>> Voxels::knownRange(int step, int level,
                                                            const core::Box3i& samples) const
{
    // A user's source may throw; nothing may pass from here through OSG's callbacks.
    try {
        return _source->stepRange(step, level, samples);
    } catch (...) {
        return std::nullopt;
    }
}

// As the source knows it, or of the samples of the coarsest level.
core::ValueRange Voxels::findStepRange(int step) const
{
    core::ValueRange found;
    if (const auto known = knownRange(step, 0, {glm::ivec3(0), _description.size}))
        return {known->first, known->second};
    for (const std::int64_t page : _tree.roots(glm::dvec4(0.0, 0.0, 1.0, 0.0))) {
        const Result<VoxelBlock> block = readPage(page, step);
        if (!block.ok()) continue;
        found.expand(core::scanRange({block->data, _description.type, _description.components,
                                      _tree.brick(page).samples.size()},
                                     significantComponent(_description)));
    }
    return found;
}

void Voxels::findRange() const
{
    core::ValueRange found;
    if (isPaged()) {
        constexpr int MOST = 5; // steps, which may have to be opened for it
        const int count = std::min(_stepCount, MOST);
        for (int i = 0; i < count; ++i)
            found.expand(findStepRange(
                static_cast<int>(std::int64_t(i) * (_stepCount - 1) / std::max(count - 1, 1))));
    } else if (const auto known = knownRange(0, 0, {glm::ivec3(0), _description.size})) {
        found = {known->first, known->second};
    } else {
        for (std::int64_t i = 0; i < _layout.brickCount(); ++i) {
            const auto range = getBrickRange(i);
            found.expand({range.first, range.second});
        }
    }
    // A single value still needs two ends, and no value at all any two.
    if (found.empty()) found = {0.0, 1.0};
    if (!(found.high - found.low >= core::RANGE_WIDTH.low))
        found.high = found.low + std::max(1.0, std::fabs(found.low) * 1e-6);
    if (!std::isfinite(found.high - found.low)) found = {0.5 * found.low, 0.5 * found.high};
    _range.set(found.low, found.high);
    _rangeKnown = true;
}

ReportedStatus Voxels::setBrickSize(const osg::Vec3i& samples)
{
    return rebuildLayout({samples.x(), samples.y(), samples.z()}, _overlap, _partialBricks);
}

ReportedStatus Voxels::setPartialBricks(core::PartialBricks partial)
{
    return rebuildLayout(_brickSize, _overlap, partial);
}

ReportedStatus Voxels::setOverlap(int samples)
{
    return rebuildLayout(_brickSize, samples, _partialBricks);
}

Status Voxels::requireOverlap(int samples)
{
    if (samples <= _overlap) return {};
    if (valid() && _layout.brickCount() == 1 && !isPaged()) {
        // A single brick is all of the voxels, however much it would share.
        Result<core::BrickLayout> layout =
            core::BrickLayout::create(_description.size, _brickSize, samples, _partialBricks);
        if (layout.ok() && layout->brickCount() == 1) {
            _layout = *layout;
            _overlap = samples;
            return {};
        }
    }
    const CallerReports quiet;
    return rebuildLayout(_brickSize, samples, _partialBricks);
}

ReportedStatus Voxels::rebuildLayout(const glm::ivec3& brickSize, int overlap,
                                     core::PartialBricks partial)
{
    // Without voxels, a volume of one sample stands in, so that the numbers are checked just the
    // same.
    const glm::ivec3 size = valid() ? _description.size : glm::ivec3(1);
    core::BrickTree tree;
    if (Status status = makeTree(_source.get(), overlap, tree); !status.ok())
        return reported(std::move(status));
    const Result<core::BrickLayout> layout = makeLayout(size, brickSize, overlap, partial, tree);
    if (!layout.ok()) return reported(layout.status);
    _brickSize = brickSize;
    _overlap = overlap;
    _partialBricks = partial;
    _tree = tree;
    if (valid()) _layout = *layout;
    forgetBricks();
    return {};
}

void Voxels::forgetBricks()
{
    _cache.clear();
    _pickData.clear();
    std::lock_guard<std::mutex> lock(_mutex);
    _bricks.clear();
    _allModified = ++_lastModified;
    _changes.forget(_lastModified);
    _layoutCount = nextLayoutCount();
}

void Voxels::dirty(std::int64_t brick)
{
    if (brick < 0) _pickData.clear();
    std::lock_guard<std::mutex> lock(_mutex);
    if (brick < 0) {
        _cache.clear();
        _bricks.clear();
        _allModified = ++_lastModified;
        _changes.forget(_lastModified);
    } else if (brick < _layout.brickCount()) {
        // A fresh one: threads that read the old one may finish with it.
        auto fresh = std::make_shared<Brick>();
        BrickPtr& known = _bricks[brick];
        _cache.remove({brick, known ? known->modified : _allModified});
        fresh->modified = ++_lastModified;
        _changes.forget(_lastModified);
        known = std::move(fresh);
    }
}

void Voxels::dirtyRegions(const std::vector<core::Box3i>& samples)
{
    const std::vector<core::Box3i> inside =
        core::clipped(samples, {glm::ivec3(0), _description.size});
    if (inside.empty()) return;
    const std::vector<std::int64_t> touched =
        isPaged() ? std::vector<std::int64_t>() : bricksWith(inside);
    std::lock_guard<std::mutex> lock(_mutex);
    const unsigned modified = ++_lastModified;
    constexpr std::size_t MANY_UNSEEN = 1 << 14; // of more, all of the brick is looked at again
    for (const std::int64_t index : touched) {
        auto fresh = std::make_shared<Brick>();
        BrickPtr& known = _bricks[index];
        _cache.remove({index, known ? known->modified : _allModified});
        if (known) {
            std::lock_guard<std::mutex> brickLock(known->mutex);
            fresh->range = known->range;
            fresh->rangeKnown = known->rangeKnown;
            fresh->unseen = known->unseen;
        }
        if (fresh->rangeKnown)
            for (const core::Box3i& part : core::clipped(inside, _layout.brick(index).samples))
                fresh->unseen.push_back(part);
        if (fresh->unseen.size() > MANY_UNSEEN) {
            fresh->unseen.clear();
            fresh->rangeKnown = false;
        }
        fresh->modified = modified;
        known = std::move(fresh);
    }
    _changes.add(inside, modified);
}

// Bricks that have any of the samples of boxes.
std::vector<std::int64_t> Voxels::bricksWith(const std::vector<core::Box3i>& samples) const
{
    std::set<std::int64_t> found;
    const glm::ivec3 count = _layout.count();
    for (const core::Box3i& box : samples) {
        std::vector<int> onAxis[3];
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < count[axis]; ++i) {
                glm::ivec3 brick(0);
                brick[axis] = i;
                const core::Box3i has = _layout.brick(_layout.index(brick)).samples;
                if (box.min[axis] < has.max[axis] && has.min[axis] < box.max[axis])
                    onAxis[axis].push_back(i);
            }
        for (const int z : onAxis[2])
            for (const int y : onAxis[1])
                for (const int x : onAxis[0])
                    found.insert(_layout.index({x, y, z}));
    }
    return {found.begin(), found.end()};
}

std::optional<std::vector<core::Box3i>> Voxels::getChanges(unsigned count,
                                                           const core::Box3i& within) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _changes.since(count, within);
}

unsigned Voxels::getChangeCount() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _lastModified;
}

Result<VoxelBlock> Voxels::readSamples(const core::Box3i& samples) const
{
    if (!valid()) return Status(ErrorCode::VALUE_INVALID, "there are no voxels to read");
    Status status;
    bool shared = false;
    Block block = readBrick(0, 0, samples, shared, status);
    if (status.ok()) return block;
    return status;
}

unsigned Voxels::getModifiedCount(std::int64_t brick) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _bricks.find(brick);
    return found == _bricks.end() ? _allModified : found->second->modified;
}

Voxels::BrickPtr Voxels::findBrick(std::int64_t brick) const
{
    if (brick < 0 || brick >= _layout.brickCount()) return {};
    std::lock_guard<std::mutex> lock(_mutex);
    BrickPtr& found = _bricks[brick];
    if (!found) {
        found = std::make_shared<Brick>();
        found->modified = _allModified;
    }
    return found;
}

Voxels::Block Voxels::readBrick(int step, int level, const core::Box3i& samples, bool& shared,
                                Status& status) const
{
    try { // as in knownRange()
        const std::int64_t bytes =
            core::voxelBytes(samples.size(), _description.type, _description.components);
        const Block own = step == 0 && level == 0 ? _source->share(samples) : Block();
        shared = own && own.bytes == static_cast<std::size_t>(bytes);
        if (shared) return own;
        const std::shared_ptr<unsigned char> data = allocateBrick(static_cast<std::size_t>(bytes));
        status = _source->readStep(step, level, samples, data.get());
        if (status.ok()) return {data, data.get(), static_cast<std::size_t>(bytes)};
    } catch (const std::bad_alloc&) {
        status = {ErrorCode::TOO_LARGE, "there is no memory for a brick of voxels"};
    } catch (const std::exception& e) {
        status = {ErrorCode::FILE_UNREADABLE, std::string("the voxel source threw: ") + e.what()};
    } catch (...) {
        status = {ErrorCode::FILE_UNREADABLE, "the voxel source threw"};
    }
    return {};
}

/// Expects brick.mutex to be held.
Voxels::Block Voxels::loadBrick(std::int64_t index, Brick& brick) const
{
    if (brick.failed) return {};
    Block block = _cache.find({index, brick.modified});
    if (block) return block;
    Status status;
    bool shared = false;
    ++_readCount;
    block = readBrick(0, 0, _layout.brick(index).samples, shared, status);
    brick.failed = !status.ok();
    if (block) _cache.add({index, brick.modified}, block, shared);
    if (brick.failed) {
        status.text = "brick " + std::to_string(index) +
                      (_fileName.empty() ? "" : " of " + _fileName) + ": " + status.text;
        if (status.index < 0) status.index = index;
        reportError(status);
    }
    return block;
}

Voxels::Block Voxels::getBrick(std::int64_t index) const
{
    const BrickPtr brick = findBrick(index);
    if (!brick) return {};
    std::lock_guard<std::mutex> lock(brick->mutex);
    return loadBrick(index, *brick);
}

void Voxels::releaseBrick(std::int64_t index) const
{
    const BrickPtr brick = findBrick(index);
    if (!brick) return;
    _cache.remove({index, brick->modified});
}

std::pair<double, double> Voxels::getBrickRange(std::int64_t index) const
{
    const BrickPtr brick = findBrick(index);
    if (!brick) return {core::ValueRange().low, core::ValueRange().high};
    std::lock_guard<std::mutex> lock(brick->mutex);
    if (!brick->rangeKnown) {
        const core::Box3i samples = _layout.brick(index).samples;
        if (const auto known = knownRange(0, 0, samples)) {
            brick->range = {known->first, known->second};
        } else if (const Block block = loadBrick(index, *brick)) {
            brick->range = core::scanRange(
                {block.data, _description.type, _description.components, samples.size()},
                significantComponent(_description));
        }
        brick->rangeKnown = true;
        brick->unseen.clear();
    }
    widenRange(*brick);
    return {brick->range.low, brick->range.high};
}

// By samples that have changed since the range was found. Expects brick.mutex to be held.
void Voxels::widenRange(Brick& brick) const
{
    for (const core::Box3i& samples : core::coveringBoxes(brick.unseen)) {
        const Result<VoxelBlock> block = readSamples(samples);
        if (!block.ok()) continue; // reported where it is drawn
        brick.range.expand(core::scanRange(
            {block->data, _description.type, _description.components, samples.size()},
            significantComponent(_description)));
    }
    brick.unseen.clear();
}

void Voxels::resizeGLObjectBuffers(unsigned int maximum)
{
    _renderData.resizeGLObjectBuffers(maximum);
}

void Voxels::releaseGLObjects(osg::State* state) const
{
    _renderData.releaseGLObjects(state);
}

} // namespace osgVolumizer
