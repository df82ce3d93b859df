// Any tetrahedra cut by any plane and any polygon: refused with a reason and nothing touched, or
// one surface whose faces are in order.
#include "CoreInput.h"

using namespace osgVolumizer;
using namespace osgVolumizer::fuzz;

namespace {

void checkOutcome(const Status& status, core::PolygonizedFaces& out)
{
    if (status.ok()) {
        check(out, 1);
        return;
    }
    expect(!status.text.empty());
    expect(out.faces.empty() && out.ranges.empty());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    Input input(data, size);
    core::Plane plane;
    plane.normal = input.vector();
    plane.offset = input.number();
    const glm::dvec3 origin = input.take<std::uint8_t>() & 1 ? input.vector() : glm::dvec3(0.0);
    std::vector<glm::dvec3> polygon(input.take<std::uint8_t>() % 9);
    const bool flat = input.take<std::uint8_t>() & 1; // most others are refused
    for (glm::dvec3& p : polygon) {
        p = input.vector();
        if (flat) p.z = 0.25;
    }
    const std::vector<core::Box3d> boxes = clipBoxes(input);
    core::Polygonizer polygonizer;
    const auto set = std::make_shared<const core::TetraSet>(tetraSet(input));
    if (!polygonizer.setTetraSet(set).ok() || !polygonizer.setClipBoxes(boxes).ok()) return 0;

    core::PolygonizedFaces byPlane, byPolygon;
    checkOutcome(polygonizer.polygonizeMPR(plane, origin, byPlane), byPlane);
    checkOutcome(polygonizer.polygonizeMPR(polygon, origin, byPolygon), byPolygon);
    return 0;
}
