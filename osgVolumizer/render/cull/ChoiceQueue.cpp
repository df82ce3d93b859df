#include "ChoiceQueue.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace osgVolumizer {
namespace render {

ChoiceQueue& ChoiceQueue::instance()
{
    // Never destroyed: the thread may still be at work.
    static ChoiceQueue* const queue = new ChoiceQueue;
    static const struct AtExit
    {
        ~AtExit() { queue->end(); }
    } atExit;
    return *queue;
}

// Expects the lock.
ChoiceQueue::Jobs::iterator ChoiceQueue::jobOf(const void* owner)
{
    return std::find_if(_jobs.begin(), _jobs.end(),
                        [owner](const auto& known) { return known.first == owner; });
}

void ChoiceQueue::ask(const void* owner, std::function<void()> job)
{
    std::function<void()> replaced; // destroyed last, without the lock
    std::lock_guard<std::mutex> lock(_mutex);
    if (_stopping) return;
    const auto waiting = jobOf(owner);
    if (waiting != _jobs.end()) {
        replaced = std::move(waiting->second);
        waiting->second = std::move(job);
    } else {
        _jobs.emplace_back(owner, std::move(job));
    }
    if (_running) return;
    _running = true;
    std::thread([this] { work(); }).detach();
}

void ChoiceQueue::forget(const void* owner)
{
    std::function<void()> dropped; // destroyed last, without the lock
    std::lock_guard<std::mutex> lock(_mutex);
    const auto waiting = jobOf(owner);
    if (waiting == _jobs.end()) return;
    dropped = std::move(waiting->second);
    _jobs.erase(waiting);
}

void ChoiceQueue::end()
{
    std::unique_lock<std::mutex> lock(_mutex);
    _stopping = true;
    _jobs.clear();
    _idle.wait_for(lock, std::chrono::seconds(2), [this] { return !_running; });
}

void ChoiceQueue::work()
{
    std::unique_lock<std::mutex> lock(_mutex);
    while (!_stopping && !_jobs.empty()) {
        std::function<void()> job = std::move(_jobs.front().second);
        _jobs.pop_front();
        lock.unlock();
        job();
        job = nullptr;
        lock.lock();
    }
    _running = false;
    _idle.notify_all();
}

} // namespace render
} // namespace osgVolumizer
