#include "FileHead.h"
#include "LegacyText.h"

#include <osgVolumizer/core/Text.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace osgVolumizer {
namespace vtkimage {

namespace {

/// Walks through the sections of a file.
class LegacySections
{
public:
    explicit LegacySections(const std::string& path) : _text(path) {}
    Result<FileHead> read();

private:
    static Status damaged(const std::string& what) { return {ErrorCode::FILE_UNREADABLE, what}; }
    Status section(const std::string& name);
    Status geometry(const std::string& name);
    Status attribute(const std::string& section);
    Status scalars();
    Status field();
    Status data(const std::string& name, const std::string& type, std::int64_t components,
                std::int64_t tuples);
    void skipMetaData();

    LegacyText _text;
    FileHead _head;
    bool _binary = false;
    std::int64_t _size[3] = {0, 0, 0};
    std::int64_t _tuples = -1; ///< of the data of points or cells; -1 before
    bool _cells = false;
};

// Blanks and the like in names are %20.
std::string decodedName(const std::string& name)
{
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name[i] == '%' && i + 2 < name.size()) {
            text += static_cast<char>(std::strtol(name.substr(i + 1, 2).c_str(), nullptr, 16));
            i += 2;
        } else
            text += name[i];
    }
    return text;
}

Result<FileHead> LegacySections::read()
{
    std::string rest;
    _text.line(rest);
    _text.line(rest);
    const std::string coding = _text.keyword();
    if (coding != "ascii" && coding != "binary")
        return damaged("its third line says neither ASCII nor BINARY");
    _binary = coding == "binary";
    if (_text.keyword() != "dataset") return damaged("section DATASET is missing");
    const std::string kind = _text.word();
    if (kind == "RECTILINEAR_GRID" || kind == "rectilinear_grid")
        _head.rectilinear = true;
    else if (kind != "STRUCTURED_POINTS" && kind != "structured_points")
        return notAVolume(kind);
    for (std::string name = _text.keyword(); !name.empty(); name = _text.keyword())
        if (Status status = section(name); !status.ok()) return status;
    if (_size[0] == 0) return damaged("section DIMENSIONS is missing");
    return _head;
}

Status LegacySections::section(const std::string& name)
{
    if (name == "metadata") {
        skipMetaData();
        return {};
    }
    if (name == "field") return field();
    if (name == "point_data" || name == "cell_data") {
        _cells = name == "cell_data";
        std::int64_t expected = 1;
        for (const std::int64_t n : _size)
            expected *= _cells ? std::max<std::int64_t>(n - 1, 1) : n;
        if (!_text.number(_tuples) || _tuples != expected)
            return damaged("section " + name + " is not of " + std::to_string(expected) +
                           " values");
        return {};
    }
    return _tuples < 0 ? geometry(name) : attribute(name);
}

Status LegacySections::geometry(const std::string& name)
{
    if (name == "dimensions") {
        std::int64_t all = 1;
        for (std::int64_t& n : _size) {
            if (!_text.number(n) || n < 1 || n > std::numeric_limits<int>::max())
                return damaged("section DIMENSIONS has no three sizes");
            // A bit each at least; fewer cells than points.
            if (all > std::max<std::int64_t>(64 * _text.bytes(), 64) / n)
                return damaged("it has " + std::to_string(_text.bytes()) +
                               " bytes, fewer than its dimensions call for");
            all *= n;
        }
        return {};
    }
    if (name == "origin" || name == "spacing" || name == "aspect_ratio") {
        double value = 0.0;
        for (int i = 0; i < 3; ++i)
            if (!core::parseNumber(_text.word(), value))
                return damaged("section " + name + " has no three numbers");
        return {};
    }
    for (int axis = 0; axis < 3 && _head.rectilinear; ++axis) {
        std::int64_t count = 0;
        if (name != std::string(1, "xyz"[axis]) + "_coordinates") continue;
        if (!_text.number(count) || count != _size[axis])
            return damaged("section " + name + " is not of " + std::to_string(_size[axis]) +
                           " values");
        return data("", _text.keyword(), 1, count);
    }
    return damaged("section \"" + name + "\" is not known");
}

Status LegacySections::attribute(const std::string& section)
{
    if (section == "scalars") return scalars();
    const std::string name = _text.word();
    std::int64_t components = 0;
    if (section == "color_scalars") {
        if (!_text.number(components)) return damaged("section color_scalars is cut short");
        std::string& active = _cells ? _head.cellScalars : _head.scalars;
        if (active.empty()) active = decodedName(name);
        return data(name, "unsigned_char", components, _tuples);
    }
    if (section == "lookup_table") {
        if (!_text.number(components)) return damaged("section lookup_table is cut short");
        return data("", "unsigned_char", 4, components);
    }
    if (section == "texture_coordinates") {
        if (!_text.number(components)) return damaged("section texture_coordinates is cut short");
    } else if (section == "vectors" || section == "normals")
        components = 3;
    else if (section == "tensors" || section == "tensors6")
        components = section == "tensors" ? 9 : 6;
    else if (section == "global_ids" || section == "pedigree_ids" || section == "edge_flags")
        components = 1;
    else
        return damaged("section \"" + section + "\" is not known");
    return data(name, _text.keyword(), components, _tuples);
}

// SCALARS name type [components], LOOKUP_TABLE name.
Status LegacySections::scalars()
{
    const std::string name = _text.word(), type = _text.keyword();
    std::string rest;
    _text.line(rest);
    std::int64_t components = 1;
    const auto words = core::splitBlanks(rest);
    if (!words.empty() && !core::parseInteger(words.front(), components))
        return damaged("section SCALARS has components of \"" + rest + "\"");
    if (_text.keyword() != "lookup_table" || _text.word().empty())
        return damaged("section SCALARS has no LOOKUP_TABLE");
    std::string& active = _cells ? _head.cellScalars : _head.scalars;
    if (active.empty()) active = decodedName(name);
    return data(name, type, components, _tuples);
}

Status LegacySections::field()
{
    std::int64_t arrays = 0;
    _text.word();
    if (!_text.number(arrays) || arrays < 0) return damaged("section FIELD is cut short");
    for (std::int64_t i = 0; i < arrays; ++i) {
        std::string name = _text.word();
        if (name == "METADATA") {
            skipMetaData();
            name = _text.word();
        }
        if (name == "NULL_ARRAY") continue;
        std::int64_t components = 0, tuples = 0;
        if (!_text.number(components) || !_text.number(tuples))
            return damaged("section FIELD ends in array " + std::to_string(i));
        if (Status status =
                data(tuples == _tuples ? name : "", _text.keyword(), components, tuples);
            !status.ok())
            return status;
    }
    return {};
}

// Expects the text before the end of the line that data follow. No name: not to be chosen.
Status LegacySections::data(const std::string& name, const std::string& type,
                            std::int64_t components, std::int64_t tuples)
{
    if (LegacyText::bitsOf(type) == 0)
        return {ErrorCode::FILE_UNREADABLE, "numbers of type \"" + type + "\" are not known"};
    const std::int64_t most = 8 * _text.bytes() + 8;
    if (components < 0 || tuples < 0 || components > most || tuples > most ||
        (tuples > 0 && components > most / tuples) ||
        !_text.skip(type, components * tuples, _binary)) {
        if (!_text.noNumber().empty())
            return damaged("\"" + _text.noNumber() + "\" stands where VTK reads a number of type " +
                           type);
        return damaged("it has " + std::to_string(_text.bytes()) + " bytes, and ends before " +
                       std::to_string(tuples) + " times " + std::to_string(components) +
                       " values of type " + type);
    }
    if (LegacyText::bitsOf(type) > 0 && components > 0 && _tuples >= 0)
        _head.add({decodedName(name), _cells, static_cast<int>(components)});
    return {};
}

void LegacySections::skipMetaData()
{
    std::string rest;
    _text.line(rest);
    while (_text.line(rest) && !rest.empty()) {
    }
}

} // namespace

Result<FileHead> readLegacyHead(const std::string& path)
{
    return LegacySections(path).read();
}

} // namespace vtkimage
} // namespace osgVolumizer
