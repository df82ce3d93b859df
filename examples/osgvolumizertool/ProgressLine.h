#pragma once

#include <chrono>
#include <string>

/// Says on the standard error how far a long work is: one line, rewritten, on a terminal; elsewhere
/// a line for every tenth. Work that takes less than a second says nothing.
class ProgressLine
{
public:
    ProgressLine(std::string what, bool quiet);
    ~ProgressLine();
    void operator()(double fraction);

private:
    using Clock = std::chrono::steady_clock;

    std::string _what;
    bool _quiet, _terminal;
    bool _shown = false;
    int _tenth = 0;
    Clock::time_point _start = Clock::now(), _last = _start;
};
