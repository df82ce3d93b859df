#include "ForeignTable.h"

#include "../core/Text.h"

#include <osgDB/FileNameUtils>

#include <string_view>
#include <vector>

namespace osgVolumizer {
namespace io {

namespace {

bool holds(const std::string& text, const char* part)
{
    return text.find(part) != std::string::npos;
}

struct Signature
{
    std::string_view start;
    const char* format;
};

// Binary files that may be taken for tables, since programs offer both as "colour map".
std::string signedFormat(const std::string& text)
{
    static const Signature signatures[] = {
        {"ICOL", "a binary table of ImageJ"},
        {"\x89PNG", "an image (PNG)"},
        {"\xff\xd8\xff", "an image (JPEG)"},
        {"GIF8", "an image (GIF)"},
        {std::string_view("II*\0", 4), "an image (TIFF)"},
        {std::string_view("MM\0*", 4), "an image (TIFF)"},
        {std::string_view("PK\3\4", 4), "a ZIP archive"},
        {std::string_view("\x1f\x8b", 2), "compressed (gzip)"},
    };
    for (const Signature& signature : signatures)
        if (text.compare(0, signature.start.size(), signature.start) == 0) return signature.format;
    return {};
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
    if (holds(text, "Label Name:") || holds(text, "FreeSurferColorLUT"))
        return "a colour table of FreeSurfer";
    return {};
}

// The first lines that hold anything.
std::vector<std::vector<std::string_view>> firstLines(std::string_view text, std::size_t count)
{
    std::vector<std::vector<std::string_view>> lines;
    for (const std::string_view line : core::splitText(text.substr(0, 4096), '\n')) {
        std::vector<std::string_view> words = core::splitBlanks(line.substr(0, line.find('#')));
        if (!words.empty()) lines.push_back(std::move(words));
        if (lines.size() == count) break;
    }
    return lines;
}

bool allNumbers(const std::vector<std::string_view>& words)
{
    double number = 0.0;
    for (const std::string_view word : words)
        if (!core::parseNumber(word, number)) return false;
    return true;
}

// Files of text that only their arrangement tells.
std::string arrangedFormat(const std::string& text)
{
    const auto lines = firstLines(text, 8);
    if (lines.size() < 2) return {};
    if (lines[0].front() == "Index" && lines[0].size() == 4 && allNumbers(lines[1]))
        return "a table of ImageJ (text)";
    // Settings, a number each, then a row that begins with the count of the numbers after it.
    std::size_t settings = 0;
    while (settings < lines.size() && lines[settings].size() == 1 && allNumbers(lines[settings]))
        ++settings;
    if (settings < 4 || settings == lines.size()) return {};
    double count = 0.0;
    const auto& row = lines[settings];
    if (allNumbers(row) && core::parseNumber(row.front(), count) &&
        count == static_cast<double>(row.size() - 1))
        return "a volume property of 3D Slicer";
    return {};
}

} // namespace

std::string foreignTableFormat(const std::string& text, const std::string& name)
{
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first == std::string::npos) return {};
    if (const std::string format = signedFormat(text); !format.empty()) return format;
    const bool binary = text.find('\0') != std::string::npos;
    if (binary && (text.size() == 768 || text.size() == 800)) return "a binary table of ImageJ";
    if (const std::string format = markedFormat(text.substr(0, 4096)); !format.empty())
        return format;
    if (binary) return "no text";
    if (text[first] == '{' || text[first] == '[') return jsonFormat(text);
    if (text[first] == '<') return xmlFormat(text);
    const std::string extension = osgDB::getLowerCaseFileExtension(name);
    if (extension == "vp") return "a volume property of 3D Slicer";
    if (extension == "ctbl") return "a colour table of 3D Slicer";
    return arrangedFormat(text);
}

} // namespace io
} // namespace osgVolumizer
