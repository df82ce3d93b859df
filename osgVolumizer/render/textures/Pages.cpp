#include "Pages.h"

#include "../../Paging.h"
#include "Texels.h"

#include <osg/Timer>
#include <osgGA/GUIActionAdapter>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <set>

namespace osgVolumizer {
namespace render {

namespace {

// Seconds until what failed is tried again: doubled each time.
constexpr double FIRST_RETRY = 0.25, LAST_RETRY = 30.0;
// Frames of a view whose tests of visibility are kept.
constexpr unsigned FRAMES_OF_TESTS = 6;

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
    osg::ref_ptr<osg::View> view;
    for (const auto& known : _views)
        if (known.second.state.goesOn.lock(view)) setContinuous(*view);
}

// Of the texels in memory.
std::int64_t Pages::bytesOf(const std::map<Key, Entry>& entries)
{
    std::set<const Content*> counted;
    std::int64_t bytes = 0;
    for (const auto& entry : entries) {
        const ContentPtr& content = entry.second.content;
        if (content && content->texels && counted.insert(content.get()).second)
            bytes += content->bytes;
    }
    return bytes;
}

void Pages::begin(const Voxels& voxels)
{
    const unsigned modified = voxels.getModifiedCount(-1), layout = voxels.getLayoutCount();
    const unsigned changes = voxels.getChangeCount();
    std::map<Key, Entry> forgotten; // freed without the lock
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _textureBudget = voxels.getTextureBudget();
        if (_voxels.get() == &voxels && _modified == modified && _layout == layout) {
            if (_changes == changes) return;
            forgetChanged(voxels, forgotten);
        } else {
            forgotten.swap(_entries);
            for (auto& view : _views)
                view.second.state = {};
        }
        _voxels = &voxels;
        _modified = modified;
        _layout = layout;
        _changes = changes;
        ++_generation;
        _reported = false;
    }
    PageQueue::instance().released(bytesOf(forgotten));
}

// Expects the lock. Also forgets what is being read: it may be of the state before.
void Pages::forgetChanged(const Voxels& voxels, std::map<Key, Entry>& forgotten)
{
    for (auto next = _entries.begin(); next != _entries.end();) {
        const core::Box3i samples =
            core::samplesBelow(voxels.getTree(), voxels.getTree().brick(next->first.page));
        const auto changed = voxels.getChanges(_changes, samples);
        next->second.reading = false;
        const auto entry = next++;
        if (changed && changed->empty() && entry->second.content) continue;
        forgotten.insert(std::move(*entry));
        _entries.erase(entry);
    }
}

Pages::Page Pages::look(const Look& look)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _frame = std::max(_frame, look.frame);
    const auto found = _entries.find(look.key);
    if (found == _entries.end()) return {};
    if (const ContentPtr& content = found->second.content) {
        Content& c = *content;
        // Of the time steps that share it the one that is most wanted counts.
        c.priority =
            c.lastFrame == look.frame ? std::max(c.priority, look.priority) : look.priority;
        c.lastFrame = look.frame;
        c.texture->setUse(look.frame, c.priority);
        if (c.texture->isIn(look.contextId)) return {RESIDENT, c.texture, c.texels, 0, c.cells};
        if (c.texels) return {READ, c.texture, c.texels, c.offers, c.cells};
    }
    return {found->second.failures > 0 ? FAILED : ABSENT, nullptr, nullptr, 0, nullptr};
}

void Pages::offer(const Key& key)
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _entries.find(key);
    if (found != _entries.end() && found->second.content) ++found->second.content->offers;
}

void Pages::provide(const Key& key, const Voxels& voxels, double value)
{
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _entries.find(key);
        const bool known = found != _entries.end() && found->second.content;
        if (known && !found->second.content->isGone()) return;
    }
    auto content = std::make_shared<Content>();
    content->texels = uniformTexel(voxels, value, key.gradients); // too small to count
    content->texture = new BrickTexture(texelFormat(voxels, key.gradients), glm::ivec3(1),
                                        std::numeric_limits<std::int64_t>::max());
    const ContentPtr twin = findTwin(key, *content->texels);
    std::lock_guard<std::mutex> lock(_mutex);
    keep(key, twin, content);
}

Pages::ViewState Pages::stateOf(std::uint64_t viewId) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _views.find(viewId);
    return found == _views.end() ? ViewState() : found->second.state;
}

void Pages::setState(std::uint64_t viewId, unsigned frame, const ViewState& state)
{
    std::lock_guard<std::mutex> lock(_mutex);
    View& view = _views[viewId];
    view.frame = std::max(view.frame, frame);
    view.state = state;
}

void Pages::addTest(std::uint64_t viewId, const std::shared_ptr<VisibilityTest>& test)
{
    std::lock_guard<std::mutex> lock(_mutex);
    auto& tests = _views[viewId].tests;
    tests.push_front(test);
    if (tests.size() > FRAMES_OF_TESTS) tests.pop_back();
}

std::shared_ptr<const VisibilityTest> Pages::lastTest(std::uint64_t viewId, unsigned frame) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto view = _views.find(viewId);
    if (view == _views.end()) return nullptr;
    for (const auto& test : view->second.tests)
        if (test->isClosed() && test->frame() + FRAMES_OF_TESTS >= frame) return test;
    return nullptr;
}

bool Pages::hadOpaque(std::uint64_t viewId) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const auto view = _views.find(viewId);
    if (view == _views.end()) return false;
    for (const auto& test : view->second.tests)
        if (test->hadOpaque()) return true;
    return false;
}

void Pages::setContinuous(osg::View& view)
{
    auto* viewer = dynamic_cast<osgGA::GUIActionAdapter*>(&view);
    if (!viewer) return;
    bool any = false;
    for (const auto& pages : Registry::instance().living()) {
        std::lock_guard<std::mutex> lock(pages->_mutex);
        for (const auto& known : pages->_views)
            any = any || known.second.state.goesOn == &view;
    }
    viewer->requestContinuousUpdate(any);
}

std::size_t Pages::viewCount(unsigned frame, Pages& pages, std::uint64_t viewId)
{
    {
        std::lock_guard<std::mutex> lock(pages._mutex);
        pages._views[viewId].frame = frame;
    }
    std::size_t count = 0;
    for (const auto& each : Registry::instance().living()) {
        std::lock_guard<std::mutex> lock(each->_mutex);
        for (auto view = each->_views.begin(); view != each->_views.end();) {
            const bool seen = view->second.frame + 1 >= frame;
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
            const bool there = entry.content && entry.content->texels;
            return there || entry.reading || entry.retryTime > time;
        };
        requests.erase(std::remove_if(requests.begin(), requests.end(), isOfNoUse), requests.end());
    }
    waiting += static_cast<std::int64_t>(requests.size());
    PageQueue::instance().ask(shared_from_this(), viewId, std::move(requests));
    return waiting;
}

// The content of the time step before or after, where that is the same; else null.
Pages::ContentPtr Pages::findTwin(const Key& key, const osg::Image& texels) const
{
    std::vector<std::pair<ContentPtr, osg::ref_ptr<const osg::Image>>> neighbours;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        for (const int way : {-1, 1}) {
            const auto found = _entries.find({key.page, key.gradients, key.step + way});
            if (found == _entries.end() || !found->second.content) continue;
            if (const auto& other = found->second.content->texels)
                neighbours.push_back({found->second.content, other});
        }
    }
    const std::size_t bytes = texels.getTotalSizeInBytes();
    for (const auto& [content, other] : neighbours)
        if (other->getTotalSizeInBytes() == bytes &&
            std::memcmp(other->data(), texels.data(), bytes) == 0)
            return content;
    return nullptr;
}

// Expects the lock. Keeps what a page turned out to be, as its twin where there is one. Returns the
// bytes that are kept more.
std::int64_t Pages::keep(const Key& key, const ContentPtr& twin, const ContentPtr& content)
{
    ContentPtr& kept = _entries[key].content;
    // What a context still has stays.
    if (!kept || kept->isGone()) kept = twin ? twin : content;
    if (kept != content && kept->texels) return 0;
    kept->texels = content->texels;
    kept->bytes = content->bytes;
    kept->offers = 0;
    kept->lastFrame = _frame;
    return content->bytes;
}

std::int64_t Pages::read(const Key& key)
{
    osg::ref_ptr<const Voxels> voxels;
    unsigned generation = 0;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (!_voxels.lock(voxels)) return 0;
        Entry& entry = _entries[key];
        if ((entry.content && entry.content->texels) || entry.reading) return 0;
        entry.reading = true;
        generation = _generation;
    }
    auto content = std::make_shared<Content>();
    const core::TreeBrick brick = voxels->getTree().brick(key.page);
    Result<VoxelBlock> block = voxels->readPage(key.page, key.step);
    try {
        if (block.ok()) {
            content->texels = makeTexels(*voxels, *block, brick.samples.size(), key.gradients);
            content->cells = std::make_shared<PageCells>(*voxels, brick, *block);
            content->bytes = static_cast<std::int64_t>(content->texels->getTotalSizeInBytes());
            content->texture =
                new BrickTexture(texelFormat(*voxels, key.gradients), brick.samples.size(),
                                 std::numeric_limits<std::int64_t>::max());
        }
    } catch (const std::exception&) {
        block = Status(ErrorCode::TOO_LARGE, "there is no memory for a page of voxels");
    }
    const ContentPtr twin = block.ok() ? findTwin(key, *content->texels) : nullptr;
    std::lock_guard<std::mutex> lock(_mutex);
    if (generation != _generation) return 0; // of other data; the entry is another's
    Entry& entry = _entries[key];
    entry.reading = false;
    if (!block.ok()) {
        fail(key, block.status);
        return 0;
    }
    entry.failures = 0;
    entry.retryTime = 0.0;
    return keep(key, twin, content);
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
    std::vector<std::pair<std::pair<unsigned, float>, Content*>> byUse;
    for (const auto& item : _entries) {
        const ContentPtr& content = item.second.content;
        if (!content || !content->texels || content->bytes == 0) continue;
        const bool wanted = content->lastFrame + 1 >= _frame && content->priority >= 0.0f;
        if (!wanted || content->texture->isAnywhere())
            byUse.push_back({{content->lastFrame, content->priority}, content.get()});
    }
    std::sort(byUse.begin(), byUse.end());
    for (auto next = byUse.begin(); count < bytes && next != byUse.end(); ++next) {
        Content& content = *next->second;
        if (!content.texels) continue; // it stands there for another time step too
        freed.push_back(content.texels);
        count += content.bytes;
        content.texels = nullptr;
    }
    if (count > 0) eraseGone(nullptr);
    return count;
}

// Expects the lock. Forgets what is nowhere any more, but for what is about to be uploaded.
void Pages::eraseGone(const BrickTexture* kept)
{
    for (auto next = _entries.begin(); next != _entries.end();) {
        const Entry& entry = next->second;
        const bool gone = entry.content && !entry.reading && entry.content->texture != kept &&
                          entry.content->isGone();
        next = gone ? _entries.erase(next) : std::next(next);
    }
}

std::int64_t Pages::textureBudget() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _textureBudget;
}

std::vector<Pages::ContentPtr> Pages::contents() const
{
    std::vector<ContentPtr> result;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& entry : _entries)
            if (entry.second.content) result.push_back(entry.second.content);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

void Pages::makeRoom(osg::State& state, const BrickTexture& texture)
{
    std::vector<osg::ref_ptr<ResidentTexture>> others;
    const std::vector<std::shared_ptr<Pages>> all = Registry::instance().living();
    for (const auto& pages : all) {
        std::vector<osg::ref_ptr<ResidentTexture>> own;
        bool isOwn = false;
        for (const ContentPtr& content : pages->contents()) {
            isOwn = isOwn || content->texture == &texture;
            if (content->texture != &texture) own.push_back(content->texture);
        }
        if (const std::int64_t budget = isOwn ? pages->textureBudget() : 0)
            keepWithin(budget - texture.bytes(), own, state);
        others.insert(others.end(), own.begin(), own.end());
    }
    keepWithin(getPagingBudget().textureBytes - texture.bytes(), others, state);
    for (const auto& pages : all) {
        std::lock_guard<std::mutex> lock(pages->_mutex);
        pages->eraseGone(&texture);
    }
}

std::int64_t Pages::textureBytes(unsigned contextId)
{
    std::int64_t sum = 0;
    for (const auto& pages : Registry::instance().living())
        for (const ContentPtr& content : pages->contents())
            if (content->texture->isIn(contextId)) sum += content->texture->bytes();
    return sum;
}

void Pages::resizeGLObjectBuffers(unsigned int maximum)
{
    for (const ContentPtr& content : contents()) {
        content->texture->resizeGLObjectBuffers(maximum);
        if (content->cells) content->cells->resizeGLObjectBuffers(maximum);
    }
}

void Pages::releaseGLObjects(osg::State* state)
{
    for (const ContentPtr& content : contents()) {
        content->texture->releaseGLObjects(state);
        if (content->cells) content->cells->releaseGLObjects(state);
    }
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
    constexpr double SHARE = 0.1;
    std::lock_guard<std::mutex> lock(_mutex);
    if (frame != _frame) {
        const double begin = now();
        const double last = frame == _frame + 1 ? 1e3 * (begin - _begin) : 0.0;
        _allowed = std::max(getPagingBudget().uploadMilliseconds, SHARE * last);
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
