#pragma once

#include <condition_variable>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Whoever keeps pages in main memory. Every method may be called from any thread.
class PageKeeper
{
public:
    /// A page: its number and time step, and which kind of texels it is to have.
    struct Key
    {
        std::int64_t page = 0;
        bool gradients = false;
        int step = 0;
        bool operator<(const Key& o) const
        {
            return std::tie(page, step, gradients) < std::tie(o.page, o.step, o.gradients);
        }
    };

    virtual ~PageKeeper() = default;
    /// Reads a page that was asked for, unless it is there, in a worker thread. Returns the bytes
    /// that are kept of it.
    virtual std::int64_t read(const Key& key) = 0;
    /// Lets go of about so many bytes of pages that can be missed, those used longest ago first.
    /// Returns how many.
    virtual std::int64_t release(std::int64_t bytes) = 0;
};

/// A page that a frame wants to have.
struct PageRequest
{
    PageKeeper::Key key;
    float priority = 0.0f;  ///< the larger, the sooner it is read
    std::int64_t bytes = 0; ///< that it will take
};

/// The threads of this process that read pages, and the bound on what pages take in main memory.
/// Threads start when something is asked for, and end when there has been nothing for a while.
/// Thread safe.
class PageQueue
{
public:
    static PageQueue& instance();

    /// What a view wants of a keeper, in place of what it wanted before.
    void ask(const std::shared_ptr<PageKeeper>& keeper, std::uint64_t viewId,
             std::vector<PageRequest> requests);
    /// Forgets what is wanted of a keeper that goes away.
    void forget(const PageKeeper& keeper);

    /// Bytes that are held of pages, those that are being read included.
    std::int64_t heldBytes() const;
    /// Tells of bytes that a keeper has let go of by itself.
    void released(std::int64_t bytes);

    /// Takes nothing any more, and waits for what is being read, for two seconds at most: the end
    /// of the process.
    void end();
    PageQueue(const PageQueue&) = delete;
    PageQueue& operator=(const PageQueue&) = delete;

private:
    struct Wanted
    {
        std::weak_ptr<PageKeeper> keeper;
        const PageKeeper* identity;
        std::uint64_t viewId;
        std::vector<PageRequest> requests; ///< the most urgent last
    };
    struct Job
    {
        std::shared_ptr<PageKeeper> keeper;
        PageRequest request;
    };

    PageQueue() = default;
    ~PageQueue() = default;
    bool takeMostUrgent(Job& job);
    bool makeRoom(std::unique_lock<std::mutex>& lock, std::int64_t bytes);
    void work();

    mutable std::mutex _mutex; ///< of what follows
    std::condition_variable _changed;
    std::list<Wanted> _wanted;
    std::vector<std::weak_ptr<PageKeeper>> _keepers; ///< that were asked
    std::int64_t _held = 0;
    int _threads = 0, _reading = 0;
    bool _stopping = false;
};

} // namespace render
} // namespace osgVolumizer
