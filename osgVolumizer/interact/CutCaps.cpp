#include "CutCaps.h"

#include "../VolumeCut.h"
#include "../VolumeSlice.h"

#include <cmath>

namespace osgVolumizer {

namespace CutCaps {

constexpr double PI = 3.14159265358979323846;

osg::ref_ptr<VolumeSlice> addSlice(osg::Group& caps)
{
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setFollowsCut(true);
    caps.addChild(slice);
    return slice;
}

osg::ref_ptr<osg::Geometry> geometryOf(const core::TriangleMesh& mesh)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3dArray> vertices = new osg::Vec3dArray;
    for (const glm::dvec3& v : mesh.vertices)
        vertices->push_back(osg::Vec3d(v.x, v.y, v.z));
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, static_cast<unsigned>(mesh.indices.size()), mesh.indices.data()));
    return geometry;
}

// So many triangles that none is farther from the sphere than 3e-4 of its radius.
core::TriangleMesh sphereOf(const osg::Vec3d& center, double radius)
{
    constexpr unsigned ROWS = 64, COLUMNS = 128;
    core::TriangleMesh mesh;
    for (unsigned i = 0; i <= ROWS; ++i)
        for (unsigned j = 0; j < COLUMNS; ++j) {
            const double a = PI * i / ROWS, b = 2.0 * PI * j / COLUMNS;
            mesh.vertices.emplace_back(center.x() + radius * std::sin(a) * std::cos(b),
                                       center.y() + radius * std::sin(a) * std::sin(b),
                                       center.z() + radius * std::cos(a));
        }
    for (unsigned i = 0; i < ROWS; ++i)
        for (unsigned j = 0; j < COLUMNS; ++j) {
            const unsigned k = (j + 1) % COLUMNS, at = i * COLUMNS, next = at + COLUMNS;
            mesh.indices.insert(mesh.indices.end(),
                                {at + j, next + j, next + k, at + j, next + k, at + k});
        }
    return mesh;
}

void addBox(const osg::BoundingBoxd& box, osg::Group& caps)
{
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {box._min[axis], box._max[axis]}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::vector<osg::Vec3d> corners(4);
            for (int i = 0; i < 4; ++i) {
                corners[std::size_t(i)][axis] = side;
                corners[std::size_t(i)][u] = i == 1 || i == 2 ? box._max[u] : box._min[u];
                corners[std::size_t(i)][v] = i >= 2 ? box._max[v] : box._min[v];
            }
            addSlice(caps)->setPolygon(corners);
        }
}

} // namespace CutCaps

osg::ref_ptr<osg::Group> createCaps(const VolumeCut& cut)
{
    using namespace CutCaps;
    osg::ref_ptr<osg::Group> caps = new osg::Group;
    for (unsigned i = 0; i < cut.getNumRegions(); ++i) {
        const CutRegion& region = cut.getRegion(i);
        switch (region.getKind()) {
        case CutRegion::HALF_SPACE:
            addSlice(*caps)->setPlane(region.getPlane());
            break;
        case CutRegion::BOX:
            addBox(region.getBox(), *caps);
            break;
        case CutRegion::SPHERE:
            addSlice(*caps)->setGeometry(
                geometryOf(sphereOf(region.getCenter(), region.getRadius())));
            break;
        case CutRegion::SURFACE:
            addSlice(*caps)->setGeometry(geometryOf(*region.getMesh()));
            break;
        case CutRegion::MASK:
            break;
        }
    }
    return caps;
}

} // namespace osgVolumizer
