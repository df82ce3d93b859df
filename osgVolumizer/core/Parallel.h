#pragma once

#include "Export.h"

#include <functional>
#include <memory>

namespace osgVolumizer {
namespace core {

/// Runs independent tasks. Nothing in core starts a thread unless it is given one of these; within
/// OSG's own threads none is given, so that nothing is oversubscribed.
class OSGVOLUMIZER_CORE_EXPORT Executor
{
public:
    virtual ~Executor() = default;
    /// The number of tasks that can run at the same time, >= 1.
    virtual int concurrency() const = 0;
    /// Calls task(0) ... task(count - 1), in any order, and returns when all have returned. Tasks
    /// do not throw. Called by one thread at a time.
    virtual void run(int count, const std::function<void(int)>& task) = 0;
};

/// A fixed number of std::threads that wait for work; the calling thread works as well.
class OSGVOLUMIZER_CORE_EXPORT ThreadPool : public Executor
{
public:
    /// \param threads in all, the caller included; 0 means one per core
    explicit ThreadPool(int threads = 0);
    ~ThreadPool() override;

    int concurrency() const override;
    void run(int count, const std::function<void(int)>& task) override;

private:
    struct Private;
    std::unique_ptr<Private> _private;
};

} // namespace core
} // namespace osgVolumizer
