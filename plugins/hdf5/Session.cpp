#include "Session.h"

#include <algorithm>

namespace osgVolumizer {
namespace hdf5 {

namespace {

std::recursive_mutex& libraryMutex()
{
    static std::recursive_mutex mutex;
    return mutex;
}

// The first error of the stack is the cause, and those behind it only say who met it.
herr_t keepFirst(unsigned number, const H5E_error2_t* error, void* text)
{
    if (number == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
    return 0;
}

} // namespace

Session::Session() : _lock(libraryMutex())
{
    H5Eget_auto2(H5E_DEFAULT, &_print, &_printTo);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session()
{
    H5Eset_auto2(H5E_DEFAULT, _print, _printTo);
}

std::string Session::reason() const
{
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keepFirst, &text);
    return text.empty() ? text : ": " + oneLine(text);
}

std::string oneLine(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

} // namespace hdf5
} // namespace osgVolumizer
