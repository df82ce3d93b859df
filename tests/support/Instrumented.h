#pragma once

namespace osgVolumizer {
namespace support {

/// Whether code is built to be looked at while it runs: ten times slower, so that tests of many
/// random or large cases take fewer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr bool INSTRUMENTED = true;
#else
constexpr bool INSTRUMENTED = false;
#endif

} // namespace support
} // namespace osgVolumizer
