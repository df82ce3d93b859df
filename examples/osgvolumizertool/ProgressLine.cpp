#include "ProgressLine.h"

#include <cmath>
#include <iostream>
#include <unistd.h>
#include <utility>

ProgressLine::ProgressLine(std::string what, bool quiet)
    : _what(std::move(what)), _quiet(quiet), _terminal(isatty(STDERR_FILENO) != 0)
{
}

ProgressLine::~ProgressLine()
{
    if (_shown && _terminal) std::cerr << '\n';
}

void ProgressLine::operator()(double fraction)
{
    using std::chrono::milliseconds;
    const Clock::time_point now = Clock::now();
    if (_quiet || now - _start < milliseconds(1000)) return;
    const int tenth = static_cast<int>(10.0 * fraction);
    const bool due =
        _terminal ? now - _last > milliseconds(100) || fraction >= 1.0 : tenth > _tenth;
    if (!due) return;
    _last = now;
    _tenth = tenth;
    _shown = true;
    const int percent = static_cast<int>(std::floor(100.0 * fraction));
    if (_terminal)
        std::cerr << '\r' << _what << ": " << percent << " %" << std::flush;
    else
        std::cerr << _what << ": " << percent << " %\n";
}
