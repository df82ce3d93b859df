// Any tetrahedra, view and parameters: either refused with a reason, or faces whose indices, ranges
// and vertices are all in order.
#include "CoreInput.h"

using namespace osgVolumizer;
using namespace osgVolumizer::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    Input input(data, size);
    const core::SamplingParameters parameters = samplingParameters(input);
    const core::View eye = view(input);
    const std::vector<core::Box3d> boxes = clipBoxes(input);
    const core::TetraSet set = tetraSet(input);

    core::PolygonizedFaces out;
    const Status status = core::polygonize(set, boxes, eye, parameters, out);
    if (status.ok())
        check(out, parameters.maximumSamples);
    else
        expect(!status.text.empty());
    return 0;
}
