#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

namespace osgVolumizer {
namespace hdf5 {

/// While one lives, no other thread of this plugin calls the HDF5 library, which as most are built
/// takes one thread at a time; and the library prints no errors. Sessions of a thread may nest.
class Session
{
public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Why the last call failed, as the end of a sentence: ": file signature not found".
    std::string reason() const;

private:
    std::unique_lock<std::recursive_mutex> _lock;
    H5E_auto2_t _print = nullptr;
    void* _printTo = nullptr;
};

/// An identifier of the library, closed at the end. Expects a Session as long as it lives.
class Handle
{
public:
    using Close = herr_t (*)(hid_t);

    Handle(hid_t id, Close close) : _id(id), _close(close) {}
    Handle(Handle&& o) noexcept : _id(std::exchange(o._id, -1)), _close(o._close) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle()
    {
        if (_id >= 0) _close(_id);
    }
    bool ok() const { return _id >= 0; }
    operator hid_t() const { return _id; }

private:
    hid_t _id;
    Close _close;
};

/// A name of a file, which may hold anything, without line ends and the like.
std::string oneLine(std::string text);

} // namespace hdf5
} // namespace osgVolumizer
