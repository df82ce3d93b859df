#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace bench {

/// The parts of "A,B,..".
inline std::vector<std::string> splitList(const std::string& text)
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ',');)
        parts.push_back(part);
    return parts;
}

/// "1;2;3", as one cell of a CSV file.
inline std::string joinValues(const std::vector<double>& values)
{
    std::ostringstream out;
    for (double v : values)
        out << (out.tellp() > 0 ? ";" : "") << v;
    return out.str();
}

} // namespace bench
} // namespace osgVolumizer
