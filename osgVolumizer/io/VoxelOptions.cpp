#include "VoxelOptions.h"

#include "../core/Text.h"

#include <cmath>

namespace osgVolumizer {
namespace io {

namespace {

bool parseTriple(std::string_view text, glm::dvec3& v)
{
    return core::parseNumbers(text, &v.x, 3) && std::isfinite(v.x) && std::isfinite(v.y) &&
           std::isfinite(v.z);
}

bool parseBrick(std::string_view text, glm::ivec3& v)
{
    std::int64_t n[3];
    const std::vector<std::string_view> pieces = core::splitText(text, ',');
    if (pieces.size() != 1 && pieces.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (!core::parseInteger(pieces[pieces.size() == 3 ? i : 0], n[i]) || n[i] < 2 ||
            n[i] > 65536)
            return false;
    v = glm::ivec3(static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]));
    return true;
}

/// Sets one option; what it expects when the value is bad, "" when all is well, null for an unknown
/// name.
const char* setOption(VoxelOptions& options, std::string_view name, std::string_view value)
{
    if (name == "spacing") {
        glm::dvec3 v;
        if (!parseTriple(value, v) || !(v.x > 0.0 && v.y > 0.0 && v.z > 0.0))
            return "three positive numbers, x,y,z";
        options.spacing = v;
    } else if (name == "origin") {
        glm::dvec3 v;
        if (!parseTriple(value, v)) return "three numbers, x,y,z";
        options.origin = v;
    } else if (name == "range") {
        glm::dvec2 v;
        if (!core::parseNumbers(value, &v.x, 2) || !(v.x < v.y) || !std::isfinite(v.y - v.x))
            return "two rising numbers, low,high";
        options.range = v;
    } else if (name == "brick") {
        glm::ivec3 v;
        if (!parseBrick(value, v)) return "one or three numbers of samples from 2 to 65536";
        options.brick = v;
    } else if (name == "unit") {
        double v = 0.0;
        if (!core::parseNumber(value, v) || !(v > 0.0) || !std::isfinite(v))
            return "a positive number";
        options.unit = v;
    } else if (name == "table") {
        if (value.empty()) return "a file name";
        options.table = std::string(value);
    } else {
        return nullptr;
    }
    return "";
}

} // namespace

std::string VoxelOptions::voxelText() const
{
    std::string text;
    const auto add = [&](const char* name, const std::string& value) {
        text += (text.empty() ? "" : " ") + std::string(name) + "=" + value;
    };
    if (spacing) add("spacing", core::formatTriple(*spacing));
    if (origin) add("origin", core::formatTriple(*origin));
    if (range) add("range", core::formatNumber(range->x) + "," + core::formatNumber(range->y));
    if (brick) add("brick", core::formatTriple(*brick));
    return text;
}

Result<VoxelOptions> parseVoxelOptions(const std::string& text)
{
    VoxelOptions options;
    for (const std::string_view word : core::splitBlanks(text)) {
        const std::size_t equals = word.find('=');
        const std::string_view name = word.substr(0, equals);
        const std::string_view value =
            equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1);
        const char* wrong = setOption(options, name, value);
        if (!wrong)
            return Status(ErrorCode::VALUE_INVALID,
                          "option \"" + std::string(word) +
                              "\" is none of spacing=, origin=, range=, brick=, unit=, table=");
        if (*wrong)
            return Status(ErrorCode::VALUE_INVALID, "option " + std::string(name) + " is \"" +
                                                        std::string(value) + "\", not " + wrong);
    }
    return options;
}

} // namespace io
} // namespace osgVolumizer
