// Any sequence of sets, boxes, parameters and views, culled to the view or not: the cache gives
// what polygonizing afresh gives, and refuses what that refuses.
#include "CoreInput.h"

#include <osgVolumizer/core/sampling/FaceCache.h>

using namespace osgVolumizer;
using namespace osgVolumizer::fuzz;

namespace {

bool same(const core::PolygonizedFaces& a, const core::PolygonizedFaces& b)
{
    const auto bits = [](const auto& x, const auto& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    return bits(a.faces.vertices, b.faces.vertices) && bits(a.faces.indices, b.faces.indices) &&
           bits(a.faces.faceOffsets, b.faces.faceOffsets) && bits(a.ranges, b.ranges) &&
           a.surfaceCount == b.surfaceCount && a.brickCount == b.brickCount && a.axis == b.axis;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    Input input(data, size);
    core::SamplingParameters parameters = samplingParameters(input);
    core::View eye = view(input);
    std::vector<core::Box3d> boxes = clipBoxes(input);
    auto set = std::make_shared<const core::TetraSet>(tetraSet(input));

    core::FaceCache cache(2);
    for (int step = 0; step < 6; ++step) {
        const auto change = input.take<std::uint8_t>();
        if (change & 1)
            eye.toEye[input.take<std::uint8_t>() % 4][input.take<std::uint8_t>() % 4] =
                input.number();
        if (change & 2) parameters.cullToView = !parameters.cullToView;
        if (change & 4) parameters.mode = static_cast<SamplingMode>(input.take<std::uint8_t>() % 3);
        if (change & 8) boxes = clipBoxes(input);
        if (change & 16) set = std::make_shared<const core::TetraSet>(tetraSet(input));
        bool polygonized = false;
        const Result<core::FaceCache::FacesPtr> faces = cache.faces(
            input.take<std::uint8_t>() % 3, set, boxes, eye, parameters, 0.0, &polygonized);
        core::PolygonizedFaces fresh;
        const Status status = core::polygonize(*set, boxes, eye, parameters, fresh);
        expect(status.ok() == faces.ok());
        if (!faces.ok()) {
            expect(!faces.status.text.empty() && !polygonized);
            continue;
        }
        check(**faces, parameters.maximumSamples);
        expect(same(**faces, fresh));
    }
    return 0;
}
