#include "ArrayList.h"

#include <vtkDataSetAttributes.h>

#include <algorithm>

namespace osgVolumizer {
namespace vtkimage {

void ArrayList::add(const ArrayInfo& array)
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

std::string ArrayList::nameOf(const ArrayInfo& array) const
{
    const bool shared =
        array.cells && std::any_of(arrays.begin(), arrays.end(), [&array](const ArrayInfo& a) {
            return !a.cells && a.name == array.name;
        });
    return (shared ? "cells:" : "") + array.name;
}

Result<ArrayInfo> ArrayList::choose(const std::string& name) const
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

Status checkChannel(std::optional<int> channel, int components)
{
    if (!channel || *channel < components) return {};
    return {ErrorCode::INDEX_OUT_OF_RANGE, "has no channel " + std::to_string(*channel) + ", but " +
                                               std::to_string(components) + ", from 0 on"};
}

} // namespace vtkimage
} // namespace osgVolumizer
