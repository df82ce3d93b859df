#include "StatsFile.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace {

std::string quoted(const std::string& text)
{
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (static_cast<unsigned char>(c) >= 0x20) {
            result += c;
            continue;
        }
        char escape[8];
        std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned>(c));
        result += escape;
    }
    return result + '"';
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// "osgVolumizer bricks drawn" becomes "bricks drawn".
std::string object(const std::map<std::string, double>& counters)
{
    std::ostringstream out;
    out.precision(17);
    const char* separator = "";
    for (const auto& counter : counters) {
        out << separator << "\n    " << quoted(counter.first.substr(counter.first.find(' ') + 1))
            << ": " << counter.second;
        separator = ",";
    }
    return "{" + out.str() + (counters.empty() ? "}" : "\n  }");
}

std::string object(const osgVolumizer::support::DrawingDevice& device)
{
    const bool numbered = device.number != osgVolumizer::support::OffscreenDisplay::SURFACELESS;
    return "{\n    \"renderer\": " + quoted(device.renderer) +
           ",\n    \"platform\": " + quoted(device.platform) +
           ",\n    \"number\": " + (numbered ? std::to_string(device.number) : "null") + "\n  }";
}

} // namespace

osgVolumizer::Status writeStatistics(const Statistics& statistics, const Arguments& arguments)
{
    std::ofstream out(arguments.stats);
    out << "{\n  \"scene\": " << quoted(arguments.scene) << ",\n  \"width\": " << arguments.width
        << ",\n  \"height\": " << arguments.height
        << ",\n  \"device\": " << object(statistics.device)
        << ",\n  \"frames\": " << statistics.milliseconds.size()
        << ",\n  \"milliseconds\": " << median(statistics.milliseconds)
        << ",\n  \"millisecondsPerFrame\": [";
    const char* separator = "";
    for (const double ms : statistics.milliseconds) {
        out << separator << ms;
        separator = ", ";
    }
    out << "],\n  \"counters\": " << object(statistics.latestFrame)
        << ",\n  \"countersOfFirstFrame\": " << object(statistics.firstFrame) << "\n}\n";
    out.close();
    if (out) return osgVolumizer::Status();
    return osgVolumizer::Status(osgVolumizer::ErrorCode::FILE_UNREADABLE,
                                "Cannot write '" + arguments.stats + "'.");
}
