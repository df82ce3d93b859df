#include "TetraSet.h"

#include <cmath>

namespace osgVolumizer {
namespace core {

Box3d TetraSet::bounds() const
{
    Box3d box;
    for (const Index i : indices)
        box.expand(vertices.position(i));
    return box;
}

Status TetraSet::validate() const
{
    const std::vector<double>& values = vertices.values();
    const VertexFormat& format = vertices.format();
    const auto stride = static_cast<std::size_t>(format.stride());
    if ((format.voxelCoordinateSize != 0 && format.voxelCoordinateSize != 3) ||
        (format.colorSize != 0 && format.colorSize != 3 && format.colorSize != 4) ||
        format.userSize < 0 || format.userSize > VertexFormat::MAX_USER_VALUES)
        return {ErrorCode::VALUE_INVALID,
                "TetraSet: the vertex format has fields of " +
                    std::to_string(format.voxelCoordinateSize) + ", " +
                    std::to_string(format.colorSize) + " and " + std::to_string(format.userSize) +
                    " values; 0 or 3, 0, 3 or 4, and 0 to 16 are possible."};
    if (values.size() % stride != 0)
        return {ErrorCode::SIZE_MISMATCH, "TetraSet: " + std::to_string(values.size()) +
                                              " values are no multiple of the record size " +
                                              std::to_string(stride) + "."};
    if (indices.size() % 4 != 0)
        return {ErrorCode::SIZE_MISMATCH, "TetraSet: " + std::to_string(indices.size()) +
                                              " indices are no multiple of four."};
    const auto good = [](double v) { return std::abs(v) <= MAX_MAGNITUDE; };
    std::size_t bad = 0; // counted without a branch, so that the loop runs at the speed of memory
    for (const double v : values)
        bad += good(v) ? 0u : 1u;
    if (bad > 0) {
        std::size_t i = 0;
        while (good(values[i]))
            ++i;
        return {ErrorCode::VALUE_INVALID,
                "TetraSet: vertex " + std::to_string(i / stride) + " has value " +
                    std::to_string(values[i]) + " in field " + std::to_string(i % stride) + ".",
                static_cast<std::int64_t>(i / stride)};
    }
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= count)
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    "TetraSet: index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                        ", but there are " + std::to_string(count) + " vertices.",
                    static_cast<std::int64_t>(i)};
    return {};
}

} // namespace core
} // namespace osgVolumizer
