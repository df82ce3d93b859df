#include "Outlines.h"

#include "VolumeGeometry.h"
#include "Voxels.h"

namespace osgVolumizer {

namespace {

// Floats would lose what lies far from the origin.
osg::ref_ptr<osg::Node> about(const osg::Matrixd& toObject, const core::LineSet& lines)
{
    osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(toObject);
    node->addChild(createLines(lines));
    return node;
}

} // namespace

osg::ref_ptr<osg::Geometry> createLines(const core::LineSet& lines)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    vertices->reserve(lines.points.size());
    for (const glm::dvec3& p : lines.points)
        vertices->push_back(osg::Vec3(osg::Vec3d(p.x, p.y, p.z)));
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    color->push_back({1.0f, 1.0f, 1.0f, 1.0f});
    geometry->setVertexArray(vertices);
    geometry->setColorArray(color);
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_LINES, static_cast<unsigned>(lines.indices.size()), lines.indices.data()));
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

osg::ref_ptr<osg::Node> createTetraOutlines(const VolumeGeometry& geometry)
{
    core::TetraSet set = *geometry.getTetraSet();
    const glm::dvec3 center = set.empty() ? glm::dvec3(0.0) : set.bounds().center();
    core::LineSet lines;
    if (!set.empty()) core::outlineTetrahedra(set, lines);
    for (glm::dvec3& p : lines.points)
        p -= center;
    return about(osg::Matrixd::translate(center.x, center.y, center.z), lines);
}

osg::ref_ptr<osg::Geometry> createFaceOutlines(const core::FaceSet& faces)
{
    core::LineSet lines;
    core::outlineFaces(faces, 0, faces.faceCount(), lines);
    return createLines(lines);
}

std::vector<core::Box3d> brickOutlines(const Voxels& voxels)
{
    std::vector<core::Box3d> boxes;
    if (!voxels.valid()) return boxes;
    if (voxels.isPaged()) {
        for (const std::int64_t root : voxels.getTree().roots(glm::dvec4(0.0, 0.0, 1.0, 0.0)))
            boxes.push_back(voxels.getTree().brick(root).clipBox);
        return boxes;
    }
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i)
        boxes.push_back(voxels.getLayout().brick(i).clipBox);
    return boxes;
}

osg::ref_ptr<osg::Node> createBrickOutlines(const Voxels& voxels)
{
    core::LineSet lines;
    core::outlineBoxes(brickOutlines(voxels), lines);
    return about(osg::Matrixd::scale(voxels.getSpacing()) *
                     osg::Matrixd::translate(voxels.getOrigin()),
                 lines);
}

} // namespace osgVolumizer
