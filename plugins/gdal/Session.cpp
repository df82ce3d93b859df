#include "Session.h"

#include <cpl_conv.h>
#include <gdal.h>

#include <algorithm>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr const char* SIDE_FILES = "GDAL_PAM_ENABLED";

std::recursive_mutex& libraryMutex()
{
    static std::recursive_mutex mutex;
    return mutex;
}

} // namespace

Session::Session() : _lock(libraryMutex())
{
    static std::once_flag once;
    std::call_once(once, GDALAllRegister);
    CPLPushErrorHandlerEx(keep, this);
    if (const char* before = CPLGetThreadLocalConfigOption(SIDE_FILES, nullptr)) _before = before;
    CPLSetThreadLocalConfigOption(SIDE_FILES, "NO");
}

Session::~Session()
{
    CPLSetThreadLocalConfigOption(SIDE_FILES, _before ? _before->c_str() : nullptr);
    CPLPopErrorHandler();
}

void CPL_STDCALL Session::keep(CPLErr kind, CPLErrorNum, const char* text)
{
    auto* session = static_cast<Session*>(CPLGetErrorHandlerUserData());
    if (kind >= CE_Failure && session && text) session->_failure = text;
}

std::string Session::reason() const
{
    return _failure.empty() ? _failure : ": " + oneLine(_failure);
}

std::string oneLine(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

} // namespace gdal
} // namespace osgVolumizer
