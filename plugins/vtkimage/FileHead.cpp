#include "FileHead.h"

#include <osgVolumizer/core/RegularFile.h>

#include <osgDB/FileNameUtils>

#include <vtkDataSetAttributes.h>

#include <algorithm>
#include <fstream>

namespace osgVolumizer {
namespace vtkimage {

void FileHead::add(const ArrayInfo& array)
{
    const auto same = [&array](const ArrayInfo& a) {
        return a.name == array.name && a.cells == array.cells;
    };
    const bool mark = array.name == vtkDataSetAttributes::GhostArrayName();
    marks = marks || mark;
    if (array.name.empty() || mark || std::any_of(arrays.begin(), arrays.end(), same)) return;
    const auto firstCells =
        std::find_if(arrays.begin(), arrays.end(), [](const ArrayInfo& a) { return a.cells; });
    arrays.insert(array.cells ? arrays.end() : firstCells, array);
}

std::string FileHead::nameOf(const ArrayInfo& array) const
{
    const bool shared =
        array.cells && std::any_of(arrays.begin(), arrays.end(), [&array](const ArrayInfo& a) {
            return !a.cells && a.name == array.name;
        });
    return (shared ? "cells:" : "") + array.name;
}

Result<ArrayInfo> FileHead::choose(const std::string& name) const
{
    constexpr std::size_t MOST_NAMES = 10;
    if (arrays.empty())
        return Status(ErrorCode::VALUE_INVALID, "there are no arrays of numbers in it");
    const auto find = [this](auto&& wanted) {
        return std::find_if(arrays.begin(), arrays.end(), wanted);
    };
    auto found = arrays.end();
    if (name.empty()) {
        found = find([this](const ArrayInfo& a) { return !a.cells && a.name == scalars; });
        if (found == arrays.end())
            found = find([this](const ArrayInfo& a) { return a.cells && a.name == cellScalars; });
        if (found == arrays.end())
            found = find([](const ArrayInfo& a) { return a.components == 1; });
        return found == arrays.end() ? arrays.front() : *found;
    }
    found = find([&](const ArrayInfo& a) { return nameOf(a) == name; });
    if (found == arrays.end())
        found = find(
            [&](const ArrayInfo& a) { return (a.cells ? "cells:" : "points:") + a.name == name; });
    if (found != arrays.end()) return *found;
    std::string known;
    for (std::size_t i = 0; i < std::min(arrays.size(), MOST_NAMES); ++i)
        known += (i ? ", " : "") + nameOf(arrays[i]);
    return Status(ErrorCode::VALUE_INVALID, "there is no array \"" + name +
                                                "\"; there are: " + known +
                                                (arrays.size() > MOST_NAMES ? ", ..." : ""));
}

Status notAVolume(const std::string& kind)
{
    const std::string k = osgDB::convertToLowerCase(kind);
    if (k == "unstructured_grid" || k == "unstructuredgrid")
        return {ErrorCode::NOT_SUPPORTED, "holds an unstructured grid, which is read as cells and "
                                          "not as voxels: open the file itself, without .volume"};
    return {ErrorCode::NOT_SUPPORTED,
            "holds a data set of VTK's kind \"" + kind +
                "\"; images (structured points), rectilinear grids and, by their own names, "
                "unstructured grids can be read"};
}

Result<FileHead> readHead(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    char first = 0;
    std::ifstream(path, std::ios::binary).get(first);
    Result<FileHead> head = first == '#' ? readLegacyHead(path) : readXmlHead(path);
    if (head.ok()) return head;
    return Status(head.status.code,
                  path + (head.status.code == ErrorCode::NOT_SUPPORTED ? " " : ": ") +
                      head.status.text);
}

} // namespace vtkimage
} // namespace osgVolumizer
