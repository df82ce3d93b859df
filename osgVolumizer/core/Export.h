#pragma once

// All symbols are visible on the platforms that we build for today; the macros mark the public
// interface for those that need it.
#if defined(_WIN32)
#define OSGVOLUMIZER_CORE_EXPORT __declspec(dllexport)
#define OSGVOLUMIZER_EXPORT __declspec(dllexport)
#else
#define OSGVOLUMIZER_CORE_EXPORT __attribute__((visibility("default")))
#define OSGVOLUMIZER_EXPORT __attribute__((visibility("default")))
#endif
