#include "VolumeSolids.h"

namespace osgVolumizer {

namespace VolumeSolids {

glm::dvec3 position(const osg::Vec3d& p)
{
    return {p.x(), p.y(), p.z()};
}

core::Box3d boxOf(const osg::BoundingBoxd& box)
{
    return {position(box._min), position(box._max)};
}

GeometryResult geometryOf(Result<core::TetraSet> solid)
{
    if (!solid) return solid.status;
    const osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    const CallerReports quiet; // whoever asked for the solid gets the reason
    if (Status s = geometry->setTetraSet(std::move(*solid)); !s) return s;
    return geometry;
}

} // namespace VolumeSolids

GeometryResult createCone(const osg::Vec3d& base, const osg::Vec3d& apex, double radius, int slices)
{
    using namespace VolumeSolids;
    return geometryOf(core::Cone{position(base), position(apex), radius, slices}.tessellate());
}

GeometryResult createCylinder(const osg::Vec3d& bottom, const osg::Vec3d& top, double radius,
                              int slices, int stacks)
{
    using namespace VolumeSolids;
    return geometryOf(
        core::Cylinder{position(bottom), position(top), radius, slices, stacks}.tessellate());
}

GeometryResult createSphere(const osg::Vec3d& center, double radius, int slices, int stacks)
{
    using namespace VolumeSolids;
    return geometryOf(core::Sphere{position(center), radius, slices, stacks}.tessellate());
}

GeometryResult createGeodesicSphere(const osg::Vec3d& center, double radius, int frequency)
{
    using namespace VolumeSolids;
    return geometryOf(core::GeodesicSphere{position(center), radius, frequency}.tessellate());
}

GeometryResult createBoxMinusSphere(const osg::BoundingBoxd& box, const osg::Vec3d& center,
                                    double radius, int divisions)
{
    using namespace VolumeSolids;
    return geometryOf(
        core::BoxMinusSphere{boxOf(box), position(center), radius, divisions}.tessellate());
}

GeometryResult createBoxMinusCylinder(const osg::BoundingBoxd& box, const osg::Vec3d& center,
                                      int axis, double radius, int divisions, int stacks)
{
    using namespace VolumeSolids;
    return geometryOf(
        core::BoxMinusCylinder{boxOf(box), position(center), axis, radius, divisions, stacks}
            .tessellate());
}

GeometryResult createCells(const core::CellSet& cells)
{
    return VolumeSolids::geometryOf(cells.tessellate());
}

GeometryResult createStrip(core::StripKind kind, const core::VertexArray& vertices,
                           const std::vector<core::TetraSet::Index>& indices)
{
    const Result<core::CellSet> cells = core::makeStrip(kind, vertices, indices);
    if (!cells) return cells.status;
    return createCells(*cells);
}

} // namespace osgVolumizer
