// Any tetrahedra, view and parameters: either refused with a reason, or faces whose indices, ranges
// and vertices are all in order.
#include <osgVolumizer/core/sampling/Polygonize.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

using namespace osgVolumizer;

namespace {

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

glm::dmat4 matrix(Input& input)
{
    glm::dmat4 m(1.0);
    for (int changes = input.take<std::uint8_t>() % 17; changes > 0; --changes) {
        const int cell = input.take<std::uint8_t>() % 16;
        m[cell / 4][cell % 4] = input.number();
    }
    return m;
}

core::TetraSet tetraSet(Input& input)
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

void expect(bool condition)
{
    if (!condition) std::abort();
}

void check(const core::PolygonizedFaces& out, int maximumSamples)
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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    Input input(data, size);
    core::SamplingParameters parameters;
    parameters.mode = static_cast<SamplingMode>(input.take<std::uint8_t>() % 4);
    parameters.space = static_cast<SamplingSpace>(input.take<std::uint8_t>() % 4);
    parameters.maximumSamples = 1 + input.take<std::uint8_t>() % 16;
    parameters.curvedTolerance = 4.0; // coarse: refinement takes long and finds nothing new
    if (input.take<std::uint8_t>() & 1) parameters.periodVoxel = input.vector();
    core::View view;
    view.toEye = matrix(input);
    view.projection = matrix(input);
    std::vector<core::Box3d> boxes(input.take<std::uint8_t>() % 4);
    for (core::Box3d& box : boxes) {
        box.min = input.vector();
        box.max = input.vector();
    }
    const core::TetraSet set = tetraSet(input);

    core::PolygonizedFaces out;
    const Status status = core::polygonize(set, boxes, view, parameters, out);
    if (status.ok())
        check(out, parameters.maximumSamples);
    else
        expect(!status.text.empty());
    return 0;
}
