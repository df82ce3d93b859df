#include "ForeignTable.h"

#include <algorithm>
#include <cctype>

namespace osgVolumizer {
namespace io {

namespace {

bool holds(const std::string& text, const char* part)
{
    return text.find(part) != std::string::npos;
}

bool endsWith(std::string name, const std::string& ending)
{
    for (char& c : name)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

std::string jsonFormat(const std::string& text)
{
    if (holds(text, "RGBPoints")) return "a ParaView colour map (JSON)";
    if (holds(text, "volumePropert") || holds(text, "VolumePropert"))
        return "a volume property of 3D Slicer (JSON)";
    return "JSON";
}

std::string xmlFormat(const std::string& text)
{
    if (holds(text, "<ColorMap")) return "a ParaView colour map (XML)";
    return "XML";
}

// Files of text that say in a comment what they are.
std::string markedFormat(const std::string& text)
{
    if (holds(text, "ITK-SnAP")) return "a label description of ITK-SNAP";
    if (holds(text, "# Color table file") || holds(text, "# Slicer Color"))
        return "a colour table of 3D Slicer";
    if (holds(text, "AmiraMesh") || holds(text, "# Avizo")) return "a colour map of Amira";
    return {};
}

} // namespace

std::string foreignTableFormat(const std::string& text, const std::string& name)
{
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first == std::string::npos) return {};
    const bool binary = text.find('\0') != std::string::npos;
    if (text.compare(0, 4, "ICOL") == 0 || (binary && (text.size() == 768 || text.size() == 800)))
        return "a binary table of ImageJ";
    if (binary) return "no text";
    if (text[first] == '{' || text[first] == '[') return jsonFormat(text);
    if (text[first] == '<') return xmlFormat(text);
    if (endsWith(name, ".vp")) return "a volume property of 3D Slicer";
    if (endsWith(name, ".ctbl")) return "a colour table of 3D Slicer";
    return markedFormat(text.substr(0, 4096));
}

} // namespace io
} // namespace osgVolumizer
