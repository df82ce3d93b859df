#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace osgVolumizer {

/// Why something was refused. The numbers are stable: they appear in messages and in stats.
enum class ErrorCode : int
{
    NONE = 0,
    FILE_NOT_FOUND = 1,
    FILE_UNREADABLE = 2, ///< cut short, or not what its name says
    SIZE_MISMATCH = 3,   ///< two sizes that must agree do not
    VALUE_INVALID = 4,   ///< NaN, infinite, negative where that has no meaning, unknown name
    INDEX_OUT_OF_RANGE = 5,
    TOO_LARGE = 6, ///< more than the stated bound, or than fits in memory
    SINGULAR_MATRIX = 7,
    NOT_SUPPORTED = 8, ///< by this file, type or graphics context
};

/// "VALUE_INVALID" and so on, for messages.
inline const char* errorName(ErrorCode code)
{
    static const char* const names[] = {"NONE",          "FILE_NOT_FOUND",  "FILE_UNREADABLE",
                                        "SIZE_MISMATCH", "VALUE_INVALID",   "INDEX_OUT_OF_RANGE",
                                        "TOO_LARGE",     "SINGULAR_MATRIX", "NOT_SUPPORTED"};
    return names[static_cast<int>(code)];
}

/// The outcome of a call that can be refused. `text` is one sentence that names file, field and
/// value; `index` is the offending element, or -1.
struct [[nodiscard]] Status
{
    ErrorCode code = ErrorCode::NONE;
    std::string text;
    std::int64_t index = -1;

    Status() = default;
    Status(ErrorCode c, std::string t, std::int64_t i = -1) : code(c), text(std::move(t)), index(i)
    {
    }

    bool ok() const { return code == ErrorCode::NONE; }
    explicit operator bool() const { return ok(); }
};

/// A value, or the reason why there is none. `value` is default-constructed on failure.
template <class T>
struct [[nodiscard]] Result
{
    T value{};
    Status status;

    Result(T v) : value(std::move(v)) {}
    Result(Status s) : status(std::move(s)) {}

    bool ok() const { return status.ok(); }
    explicit operator bool() const { return ok(); }
    T& operator*() { return value; }
    const T& operator*() const { return value; }
    T* operator->() { return &value; }
    const T* operator->() const { return &value; }
};

} // namespace osgVolumizer
