#pragma once

#include <osgVolumizer/core/sampling/Polygonize.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace osgVolumizer {
namespace fuzz {

/// Hands out the bytes of the fuzzer; zeros once they are used up.
class Input
{
public:
    Input(const unsigned char* data, std::size_t size) : _data(data), _size(size) {}

    template <class T>
    T take()
    {
        T value{};
        const std::size_t n = std::min(sizeof(T), _size);
        std::memcpy(&value, _data, n);
        _data += n;
        _size -= n;
        return value;
    }
    /// Mostly small whole numbers, where surfaces meet vertices; sometimes any bits at all.
    double number()
    {
        const auto kind = take<std::uint8_t>();
        return kind < 200 ? take<std::int8_t>() / 8.0 : take<double>();
    }
    glm::dvec3 vector()
    {
        const double x = number(), y = number();
        return {x, y, number()};
    }

private:
    const unsigned char* _data;
    std::size_t _size;
};

inline glm::dmat4 matrix(Input& input)
{
    glm::dmat4 m(1.0);
    for (int changes = input.take<std::uint8_t>() % 17; changes > 0; --changes) {
        const int cell = input.take<std::uint8_t>() % 16;
        m[cell / 4][cell % 4] = input.number();
    }
    return m;
}

inline core::TetraSet tetraSet(Input& input)
{
    core::TetraSet set;
    set.vertices = core::VertexArray(
        core::VertexFormat(static_cast<core::VertexLayout>(input.take<std::uint8_t>() % 6),
                           input.take<std::uint8_t>() % 3));
    set.vertices.resize(input.take<std::uint8_t>() % 12);
    for (double& value : set.vertices.values())
        value = input.number();
    set.indices.resize(input.take<std::uint8_t>() % 64);
    for (core::TetraSet::Index& index : set.indices)
        index = input.take<std::uint8_t>() % 13;
    return set;
}

inline void expect(bool condition)
{
    if (!condition) std::abort();
}

/// Indices, ranges and vertices are in order.
inline void check(const core::PolygonizedFaces& out, int maximumSamples)
{
    const core::FaceSet& faces = out.faces;
    const auto stride = static_cast<std::size_t>(faces.format.stride());
    expect(out.surfaceCount >= 0 && out.surfaceCount <= maximumSamples);
    expect(out.ranges.size() ==
           static_cast<std::size_t>(out.surfaceCount) * static_cast<std::size_t>(out.brickCount));
    for (const std::uint32_t index : faces.indices)
        expect(index * stride + stride <= faces.vertices.size());
    for (const core::FaceRange& range : out.ranges) {
        if (range.faceCount == 0) continue;
        expect(range.firstFace + range.faceCount < faces.faceOffsets.size());
        expect(range.firstIndex + range.indexCount <= faces.indices.size());
    }
}

inline core::SamplingParameters samplingParameters(Input& input)
{
    core::SamplingParameters parameters;
    parameters.mode = static_cast<SamplingMode>(input.take<std::uint8_t>() % 4);
    parameters.space = static_cast<SamplingSpace>(input.take<std::uint8_t>() % 4);
    parameters.maximumSamples = 1 + input.take<std::uint8_t>() % 16;
    parameters.curvedTolerance = 4.0; // coarse: refinement takes long and finds nothing new
    if (input.take<std::uint8_t>() & 1) parameters.periodVoxel = input.vector();
    return parameters;
}

inline core::View view(Input& input)
{
    core::View v;
    v.toEye = matrix(input);
    v.projection = matrix(input);
    return v;
}

inline std::vector<core::Box3d> clipBoxes(Input& input)
{
    std::vector<core::Box3d> boxes(input.take<std::uint8_t>() % 4);
    for (core::Box3d& box : boxes) {
        box.min = input.vector();
        box.max = input.vector();
    }
    return boxes;
}

} // namespace fuzz
} // namespace osgVolumizer
