#include "Pages.h"

#include "../../Paging.h"
#include "Texels.h"

#include <osg/Timer>
#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

// Seconds until what failed is tried again: doubled each time.
constexpr double FIRST_RETRY = 0.25, LAST_RETRY = 30.0;

double now()
{
    return osg::Timer::instance()->time_s();
}

// All Pages of the process.
struct Registry
{
    std::mutex mutex;
    std::vector<std::weak_ptr<Pages>> all;

    static Registry& instance()
    {
        static Registry* const registry = new Registry; // nodes may outlive what is static
        return *registry;
    }
    std::vector<std::shared_ptr<Pages>> living()
    {
        std::lock_guard<std::mutex> lock(mutex);
        std::vector<std::shared_ptr<Pages>> result;
        for (auto next = all.begin(); next != all.end();) {
            if (auto pages = next->lock()) {
                result.push_back(std::move(pages));
                ++next;
            } else {
                next = all.erase(next);
            }
        }
        return result;
    }
};

} // namespace

std::shared_ptr<Pages> Pages::create()
{
    std::shared_ptr<Pages> pages(new Pages);
    Registry& registry = Registry::instance();
    std::lock_guard<std::mutex> lock(registry.mutex);
    registry.all.push_back(pages);
    return pages;
}

Pages::~Pages()
{
    PageQueue::instance().forget(*this);
    PageQueue::instance().released(bytesOf(_entries));
}

// Of the texels in memory.
std::int64_t Pages::bytesOf(const std::map<Key, Entry>& entries)
{
    std::int64_t bytes = 0;
    for (const auto& entry : entries)
        if (entry.second.texels) bytes += entry.second.bytes;
    return bytes;
}

void Pages::begin(const Voxels& voxels)
{
    const unsigned modified = voxels.getModifiedCount(-1), layout = voxels.getLayoutCount();
    std::map<Key, Entry> forgotten; // freed without the lock
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (_voxels.get() == &voxels && _modified == modified && _layout == layout) return;
        _voxels = &voxels;
        _modified = modified;
        _layout = layout;
        ++_generation;
        _reported = false;
        forgotten.swap(_entries);
    }
    PageQueue::instance().released(bytesOf(forgotten));
}

Pages::Page Pages::look(const Look& look)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _frame = std::max(_frame, look.frame);
    const auto found = _entries.find(look.key);
    if (found == _entries.end()) return {};
    Entry& entry = found->second;
    entry.lastFrame = look.frame;
    entry.priority = look.priority;
    if (entry.texture) {
        entry.texture->setUse(look.frame, look.priority);
        if (entry.texture->isIn(look.contextId))
            return {RESIDENT, entry.texture, entry.texels, 0, entry.cells};
        if (entry.texels) return {READ, entry.texture, entry.texels, entry.offers, entry.cells};
    }
    return {entry.failures > 0 ? FAILED : ABSENT, nullptr, nullptr, 0, nullptr};
}

void Pages::offer(const Key& key)
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _entries.find(key);
    if (found != _entries.end()) ++found->second.offers;
}

void Pages::provide(const Key& key, const Voxels& voxels, double value)
{
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _entries.find(key);
        if (found != _entries.end() && found->second.texels) return;
    }
    const osg::ref_ptr<const osg::Image> texel = uniformTexel(voxels, value, key.gradients);
    std::lock_guard<std::mutex> lock(_mutex);
    Entry& entry = _entries[key];
    if (entry.texels) return;
    entry.texels = texel; // too small to count
    entry.texture = new BrickTexture(texelFormat(voxels, key.gradients), glm::ivec3(1),
                                     std::numeric_limits<std::int64_t>::max());
}

std::size_t Pages::viewCount(unsigned frame, Pages& pages, std::uint64_t viewId)
{
    {
        std::lock_guard<std::mutex> lock(pages._mutex);
        pages._views[viewId] = frame;
    }
    std::size_t count = 0;
    for (const auto& each : Registry::instance().living()) {
        std::lock_guard<std::mutex> lock(each->_mutex);
        for (auto view = each->_views.begin(); view != each->_views.end();) {
            const bool seen = view->second + 1 >= frame;
            count += seen;
            view = seen ? std::next(view) : each->_views.erase(view);
        }
    }
    return std::max<std::size_t>(count, 1);
}

std::int64_t Pages::ask(std::uint64_t viewId, std::vector<PageRequest> requests)
{
    std::int64_t waiting = 0;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const double time = now();
        const auto isOfNoUse = [&](const PageRequest& request) {
            const auto found = _entries.find(request.key);
            if (found == _entries.end()) return false;
            const Entry& entry = found->second;
            if (entry.reading) ++waiting;
            return entry.texels || entry.reading || entry.retryTime > time;
        };
        requests.erase(std::remove_if(requests.begin(), requests.end(), isOfNoUse), requests.end());
    }
    waiting += static_cast<std::int64_t>(requests.size());
    PageQueue::instance().ask(shared_from_this(), viewId, std::move(requests));
    return waiting;
}

std::int64_t Pages::read(const Key& key)
{
    osg::ref_ptr<const Voxels> voxels;
    unsigned generation = 0;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (!_voxels.lock(voxels)) return 0;
        Entry& entry = _entries[key];
        if (entry.texels || entry.reading) return 0;
        entry.reading = true;
        generation = _generation;
    }
    osg::ref_ptr<const osg::Image> texels;
    std::shared_ptr<PageCells> cells;
    const core::TreeBrick brick = voxels->getTree().brick(key.page);
    Result<VoxelBlock> block = voxels->readPage(key.page);
    try {
        if (block.ok()) {
            texels = makeTexels(*voxels, *block, brick.samples.size(), key.gradients);
            cells = std::make_shared<PageCells>(*voxels, brick, *block);
        }
    } catch (const std::exception&) {
        block = Status(ErrorCode::TOO_LARGE, "there is no memory for a page of voxels");
    }
    std::lock_guard<std::mutex> lock(_mutex);
    if (generation != _generation) return 0; // of other data; the entry is another's
    Entry& entry = _entries[key];
    entry.reading = false;
    if (!block.ok()) {
        fail(key, block.status);
        return 0;
    }
    entry.failures = entry.offers = 0;
    entry.retryTime = 0.0;
    entry.texels = texels;
    entry.cells = cells;
    entry.bytes = static_cast<std::int64_t>(texels->getTotalSizeInBytes());
    entry.lastFrame = _frame;
    if (!entry.texture)
        entry.texture = new BrickTexture(texelFormat(*voxels, key.gradients), brick.samples.size(),
                                         std::numeric_limits<std::int64_t>::max());
    return entry.bytes;
}

// Expects the lock. One message, however often.
void Pages::fail(const Key& key, const Status& status)
{
    Entry& entry = _entries[key];
    entry.retryTime = now() + std::min(FIRST_RETRY * std::ldexp(1.0, entry.failures), LAST_RETRY);
    entry.failures = std::min(entry.failures + 1, 16);
    if (_reported) return;
    _reported = true;
    reportError({status.code, status.text + "; what is there is drawn, and it is tried again"});
}

std::int64_t Pages::release(std::int64_t bytes)
{
    std::vector<osg::ref_ptr<const osg::Image>> freed; // without the lock
    std::int64_t count = 0;
    std::lock_guard<std::mutex> lock(_mutex);
    std::vector<std::pair<std::pair<unsigned, float>, Key>> byUse;
    for (const auto& item : _entries) {
        const Entry& entry = item.second;
        const bool wanted = entry.lastFrame + 1 >= _frame;
        if (entry.texels && entry.bytes > 0 && (!wanted || entry.texture->isAnywhere()))
            byUse.push_back({{entry.lastFrame, entry.priority}, item.first});
    }
    std::sort(byUse.begin(), byUse.end());
    for (auto next = byUse.begin(); count < bytes && next != byUse.end(); ++next) {
        Entry& entry = _entries[next->second];
        freed.push_back(entry.texels);
        count += entry.bytes;
        entry.texels = nullptr;
        if (!entry.texture->isAnywhere()) _entries.erase(next->second);
    }
    return count;
}

std::vector<osg::ref_ptr<BrickTexture>> Pages::textures() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    std::vector<osg::ref_ptr<BrickTexture>> result;
    for (const auto& entry : _entries)
        if (entry.second.texture) result.push_back(entry.second.texture);
    return result;
}

std::vector<std::shared_ptr<PageCells>> Pages::cells() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    std::vector<std::shared_ptr<PageCells>> result;
    for (const auto& entry : _entries)
        if (entry.second.cells) result.push_back(entry.second.cells);
    return result;
}

void Pages::makeRoom(osg::State& state, const BrickTexture& texture)
{
    std::vector<osg::ref_ptr<ResidentTexture>> others;
    const std::vector<std::shared_ptr<Pages>> all = Registry::instance().living();
    for (const auto& pages : all)
        for (const auto& other : pages->textures())
            if (other != &texture) others.push_back(other);
    keepWithin(getPagingBudget().textureBytes - texture.bytes(), others, state);
    for (const auto& pages : all) {
        std::lock_guard<std::mutex> lock(pages->_mutex);
        for (auto next = pages->_entries.begin(); next != pages->_entries.end();) {
            const Entry& entry = next->second;
            const bool empty = entry.texture && entry.texture != &texture && !entry.texels &&
                               !entry.reading && !entry.texture->isAnywhere();
            next = empty ? pages->_entries.erase(next) : std::next(next);
        }
    }
}

std::int64_t Pages::textureBytes(unsigned contextId)
{
    std::int64_t sum = 0;
    for (const auto& pages : Registry::instance().living())
        for (const auto& texture : pages->textures())
            if (texture->isIn(contextId)) sum += texture->bytes();
    return sum;
}

void Pages::resizeGLObjectBuffers(unsigned int maximum)
{
    for (const auto& texture : textures())
        texture->resizeGLObjectBuffers(maximum);
    for (const auto& page : cells())
        page->resizeGLObjectBuffers(maximum);
}

void Pages::releaseGLObjects(osg::State* state)
{
    for (const auto& texture : textures())
        texture->releaseGLObjects(state);
    for (const auto& page : cells())
        page->releaseGLObjects(state);
}

UploadAllowance& UploadAllowance::of(unsigned contextId)
{
    static std::mutex mutex;
    static auto* const all = new std::map<unsigned, std::unique_ptr<UploadAllowance>>;
    std::lock_guard<std::mutex> lock(mutex);
    auto& allowance = (*all)[contextId];
    if (!allowance) allowance = std::make_unique<UploadAllowance>();
    return *allowance;
}

bool UploadAllowance::take(unsigned frame, std::int64_t bytes)
{
    constexpr double SHARE = 0.1, MOST = 50.0;
    std::lock_guard<std::mutex> lock(_mutex);
    if (frame != _frame) {
        const double begin = now();
        const double last = frame == _frame + 1 ? 1e3 * (begin - _begin) : 0.0;
        _allowed = std::max(getPagingBudget().uploadMilliseconds, std::min(SHARE * last, MOST));
        _frame = frame;
        _begin = begin;
        _taken = 0.0;
    }
    const double time = _millisecondsPerByte * double(bytes);
    if (_taken > 0.0 && _taken + time > _allowed) return false;
    _taken += time;
    return true;
}

void UploadAllowance::measured(std::int64_t bytes, double milliseconds)
{
    // The newest counts for a quarter; a thread that had to wait for its turn tells little.
    constexpr double WEIGHT = 0.25, MOST = 4.0;
    constexpr std::int64_t SMALL = 4096; // what takes its time by itself, such as a single texel
    if (bytes < SMALL) return;
    std::lock_guard<std::mutex> lock(_mutex);
    const double rate = milliseconds / double(std::max<std::int64_t>(bytes, 1));
    const double likely = std::clamp(rate, 1e-9, MOST * _millisecondsPerByte);
    _millisecondsPerByte += WEIGHT * (likely - _millisecondsPerByte);
}

} // namespace render
} // namespace osgVolumizer
