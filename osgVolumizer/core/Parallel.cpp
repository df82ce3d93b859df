#include "Parallel.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace osgVolumizer {
namespace core {

struct ThreadPool::Private
{
    std::vector<std::thread> threads;
    std::mutex mutex;
    std::condition_variable wake, done;
    const std::function<void(int)>* task = nullptr;
    int next = 0, count = 0, finished = 0;
    bool stop = false;

    /// Takes tasks until none is left. Expects the lock, and gives it back held.
    void work(std::unique_lock<std::mutex>& lock)
    {
        while (task && next < count) {
            const int i = next++;
            const std::function<void(int)>& f = *task;
            lock.unlock();
            f(i);
            lock.lock();
            if (++finished == count) done.notify_all();
        }
    }
    void loop()
    {
        std::unique_lock<std::mutex> lock(mutex);
        while (!stop) {
            work(lock);
            if (!stop) wake.wait(lock, [this] { return stop || (task && next < count); });
        }
    }
};

ThreadPool::ThreadPool(int threads) : _private(new Private)
{
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    const int n = threads > 0 ? threads : std::max(1, cores);
    for (int i = 1; i < n; ++i)
        _private->threads.emplace_back([this] { _private->loop(); });
}

ThreadPool::~ThreadPool()
{
    {
        const std::lock_guard<std::mutex> lock(_private->mutex);
        _private->stop = true;
    }
    _private->wake.notify_all();
    for (std::thread& t : _private->threads)
        t.join();
}

int ThreadPool::concurrency() const
{
    return static_cast<int>(_private->threads.size()) + 1;
}

void ThreadPool::run(int count, const std::function<void(int)>& task)
{
    if (count <= 0) return;
    std::unique_lock<std::mutex> lock(_private->mutex);
    _private->task = &task;
    _private->next = _private->finished = 0;
    _private->count = count;
    if (count > 1) _private->wake.notify_all();
    _private->work(lock);
    _private->done.wait(lock, [this] { return _private->finished == _private->count; });
    _private->task = nullptr;
}

} // namespace core
} // namespace osgVolumizer
