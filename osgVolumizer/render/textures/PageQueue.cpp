#include "PageQueue.h"

#include "../../Paging.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace osgVolumizer {
namespace render {

namespace {

// A thread without work ends after this.
constexpr std::chrono::seconds IDLE(5);
// What cannot be read for lack of room is tried again after this.
constexpr std::chrono::milliseconds FULL(5);
constexpr std::chrono::seconds PATIENCE_AT_EXIT(2);

} // namespace

PageQueue& PageQueue::instance()
{
    // Never destroyed: a thread may still be in a source that does not answer.
    static PageQueue* const queue = new PageQueue;
    static const struct AtExit
    {
        ~AtExit() { queue->end(); }
    } atExit;
    return *queue;
}

void PageQueue::end()
{
    std::unique_lock<std::mutex> lock(_mutex);
    _stopping = true;
    _wanted.clear();
    _changed.notify_all();
    _changed.wait_for(lock, PATIENCE_AT_EXIT, [this] { return _threads == 0; });
}

void PageQueue::ask(const std::shared_ptr<PageKeeper>& keeper, std::uint64_t viewId,
                    std::vector<PageRequest> requests)
{
    std::sort(requests.begin(), requests.end(), [](const PageRequest& a, const PageRequest& b) {
        return a.priority != b.priority ? a.priority < b.priority : b.key < a.key;
    });
    const int threads = getPagingBudget().threads;
    std::lock_guard<std::mutex> lock(_mutex);
    if (_stopping) return;
    _wanted.remove_if([&](const Wanted& wanted) {
        return wanted.keeper.expired() ||
               (wanted.identity == keeper.get() && wanted.viewId == viewId);
    });
    if (requests.empty()) return;
    const auto isKeeper = [&](const std::weak_ptr<PageKeeper>& k) {
        return !k.owner_before(keeper) && !keeper.owner_before(k);
    };
    _keepers.erase(
        std::remove_if(_keepers.begin(), _keepers.end(), [](const auto& k) { return k.expired(); }),
        _keepers.end());
    if (std::none_of(_keepers.begin(), _keepers.end(), isKeeper)) _keepers.push_back(keeper);
    const auto count = static_cast<int>(std::min<std::size_t>(requests.size(), 1024));
    _wanted.push_back({keeper, keeper.get(), viewId, std::move(requests)});
    for (int i = _threads; i < std::min(threads, _reading + count); ++i) {
        ++_threads;
        std::thread([this] { work(); }).detach();
    }
    _changed.notify_all();
}

void PageQueue::forget(const PageKeeper& keeper)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _wanted.remove_if([&](const Wanted& wanted) { return wanted.identity == &keeper; });
}

std::int64_t PageQueue::heldBytes() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _held;
}

void PageQueue::released(std::int64_t bytes)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _held -= bytes;
    _changed.notify_all();
}

// Expects the lock. False where nothing is wanted.
bool PageQueue::takeMostUrgent(Job& job)
{
    while (true) {
        auto best = _wanted.end();
        for (auto wanted = _wanted.begin(); wanted != _wanted.end();) {
            if (wanted->requests.empty() || wanted->keeper.expired()) {
                wanted = _wanted.erase(wanted);
                continue;
            }
            if (best == _wanted.end() ||
                wanted->requests.back().priority > best->requests.back().priority)
                best = wanted;
            ++wanted;
        }
        if (best == _wanted.end()) return false;
        job = {best->keeper.lock(), best->requests.back()};
        best->requests.pop_back();
        if (job.keeper) return true;
    }
}

// Expects the lock, which is given up meanwhile. False where there is no room for now.
bool PageQueue::makeRoom(std::unique_lock<std::mutex>& lock, std::int64_t bytes)
{
    const std::int64_t budget = getPagingBudget().memoryBytes;
    const std::vector<std::weak_ptr<PageKeeper>> keepers = _keepers;
    std::int64_t over = _held + bytes - budget;
    for (auto next = keepers.begin(); over > 0 && next != keepers.end(); ++next) {
        std::shared_ptr<PageKeeper> keeper = next->lock();
        if (!keeper) continue;
        lock.unlock();
        const std::int64_t freed = keeper->release(over);
        keeper = nullptr; // which may be its end, and that asks for the lock
        lock.lock();
        _held -= freed;
        over = _held + bytes - budget;
    }
    // A page that is larger than all there is room for is read when nothing else is held.
    if (over > 0 && _held > 0) return false;
    _held += bytes;
    return true;
}

void PageQueue::work()
{
    std::unique_lock<std::mutex> lock(_mutex);
    while (!_stopping) {
        Job job;
        if (!takeMostUrgent(job)) {
            if (_changed.wait_for(lock, IDLE) == std::cv_status::timeout && _wanted.empty()) break;
            continue;
        }
        ++_reading;
        if (!makeRoom(lock, job.request.bytes)) {
            --_reading;
            lock.unlock();
            job.keeper = nullptr;
            std::this_thread::sleep_for(FULL); // the next frame asks again
            lock.lock();
            continue;
        }
        lock.unlock();
        const std::int64_t kept = job.keeper->read(job.request.key);
        job.keeper = nullptr; // which may be its end
        lock.lock();
        --_reading;
        _held += kept - job.request.bytes;
        _changed.notify_all();
    }
    --_threads;
    _changed.notify_all();
}

} // namespace render
} // namespace osgVolumizer
