#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <utility>

namespace osgVolumizer {
namespace render {

/// The thread of this process that makes choices which would take too long in a frame. It starts
/// when one is asked for, and ends when there is none. Thread safe.
class ChoiceQueue
{
public:
    static ChoiceQueue& instance();

    /// A job for the thread, in place of one of this owner that has not begun. It may not refer to
    /// anything that is not its own: the process may end meanwhile.
    void ask(const void* owner, std::function<void()> job);
    /// Drops a job of this owner that has not begun.
    void forget(const void* owner);
    /// Takes nothing any more, and waits for what is running, for two seconds at most: the end of
    /// the process.
    void end();
    ChoiceQueue(const ChoiceQueue&) = delete;
    ChoiceQueue& operator=(const ChoiceQueue&) = delete;

private:
    ChoiceQueue() = default;
    ~ChoiceQueue() = default;
    using Job = std::function<void()>;
    using Jobs = std::list<std::pair<const void*, Job>>;
    Jobs::iterator jobOf(const void* owner);
    void work();

    std::mutex _mutex; ///< of what follows
    std::condition_variable _idle;
    Jobs _jobs; ///< the oldest first
    bool _running = false, _stopping = false;
};

} // namespace render
} // namespace osgVolumizer
