#include "HandleShapes.h"

#include <osg/LineWidth>
#include <osg/ShapeDrawable>
#include <osgGA/GUIEventAdapter>
#include <osgManipulator/ScaleAxisDragger>
#include <osgManipulator/TabBoxDragger>
#include <osgManipulator/TrackballDragger>
#include <osgManipulator/Translate1DDragger>
#include <osgManipulator/Translate2DDragger>
#include <osgManipulator/TranslateAxisDragger>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace handleShapes {

namespace {

template <class Dragger>
osg::ref_ptr<Dragger> withGeometry(osg::ref_ptr<Dragger> dragger)
{
    dragger->setupDefaultGeometry();
    return dragger;
}

// Easier to see, and to hit, than by default.
osg::ref_ptr<osgManipulator::TranslateAxisDragger> makeArrows()
{
    osg::ref_ptr<osgManipulator::TranslateAxisDragger> arrows =
        new osgManipulator::TranslateAxisDragger;
    arrows->setConeHeight(0.2f);
    arrows->setPickCylinderRadius(0.03f);
    return arrows;
}

/// Moves in the plane through its middle that faces the eye.
class PointDragger : public osgManipulator::Translate2DDragger
{
public:
    using osgManipulator::Dragger::handle;
    bool handle(const osgManipulator::PointerInfo& pointer, const osgGA::GUIEventAdapter& event,
                osgGA::GUIActionAdapter& action) override
    {
        if (event.getEventType() == osgGA::GUIEventAdapter::PUSH && pointer.contains(this)) {
            osg::NodePath path;
            osgManipulator::computeNodePathToRoot(*this, path);
            osg::Vec3d normal =
                osg::Matrixd::transform3x3(osg::computeLocalToWorld(path), pointer.getEyeDir());
            normal.normalize();
            _projector->setPlane(osg::Plane(normal, osg::Vec3d()));
        }
        return Translate2DDragger::handle(pointer, event, action);
    }
};

// About the axes x, y and z.
osg::ref_ptr<osg::Geometry> makeCircles(double radius)
{
    constexpr int SIDES = 64;
    std::vector<osg::Vec3d> points;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 2 * SIDES; ++i) {
            const double angle = 2.0 * osg::PI * ((i + 1) / 2) / SIDES;
            osg::Vec3d p;
            p[(axis + 1) % 3] = radius * std::cos(angle);
            p[(axis + 2) % 3] = radius * std::sin(angle);
            points.push_back(p);
        }
    osg::ref_ptr<osg::Geometry> circles = makeLines();
    setLines(*circles, points);
    return circles;
}

double rowLength(const osg::Matrixd& m, int row)
{
    return osg::Vec3d(m(row, 0), m(row, 1), m(row, 2)).length();
}

} // namespace

void MixedDragger::add(osgManipulator::Dragger* dragger, double scale)
{
    dragger->setMatrix(osg::Matrixd::scale(scale, scale, scale));
    addChild(dragger);
    addDragger(dragger);
    setParentDragger(this);
}

osg::ref_ptr<osgManipulator::Dragger> makePlaneDragger()
{
    using namespace osgManipulator;
    osg::ref_ptr<MixedDragger> plane = new MixedDragger;
    osg::ref_ptr<Translate1DDragger> arrow =
        new Translate1DDragger(osg::Vec3d(0.0, -0.5, 0.0), osg::Vec3d(0.0, 0.5, 0.0));
    plane->add(withGeometry(arrow), 1.0);
    plane->add(withGeometry(osg::ref_ptr<TrackballDragger>(new TrackballDragger)), 0.2);
    osg::ref_ptr<osg::Geometry> square = makeLines();
    const osg::Vec3d a(-0.5, 0.0, -0.5), b(0.5, 0.0, -0.5), c(0.5, 0.0, 0.5), d(-0.5, 0.0, 0.5);
    setLines(*square, {a, b, b, c, c, d, d, a});
    plane->addChild(square);
    return plane;
}

osg::ref_ptr<osgManipulator::Dragger> makeBoxDragger()
{
    osg::ref_ptr<osgManipulator::TabBoxDragger> box = new osgManipulator::TabBoxDragger;
    box->setupDefaultGeometry();
    box->setPlaneColor(OUTLINE_COLOR);
    return box;
}

osg::ref_ptr<osgManipulator::Dragger> makeSphereDragger()
{
    using namespace osgManipulator;
    osg::ref_ptr<MixedDragger> sphere = new MixedDragger;
    osg::ref_ptr<ScaleAxisDragger> size = new ScaleAxisDragger;
    size->setBoxSize(0.12f);
    sphere->add(withGeometry(size), 0.5);
    sphere->add(withGeometry(makeArrows()), 0.3);
    sphere->addChild(makeCircles(0.5));
    return sphere;
}

osg::ref_ptr<osgManipulator::Dragger> makePartDragger()
{
    using namespace osgManipulator;
    osg::ref_ptr<MixedDragger> part = new MixedDragger;
    part->add(withGeometry(makeArrows()), 1.0);
    part->add(withGeometry(osg::ref_ptr<TrackballDragger>(new TrackballDragger)), 0.5);
    return part;
}

osg::ref_ptr<osgManipulator::Dragger> makePointDragger(const osg::Vec4& color)
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(0.5f);
    osg::ref_ptr<PointDragger> point = new PointDragger;
    point->setColor(color);
    point->addChild(new osg::ShapeDrawable(new osg::Sphere, hints));
    return point;
}

osg::ref_ptr<osg::Geometry> makeLines()
{
    osg::ref_ptr<osg::Geometry> lines = new osg::Geometry;
    lines->setDataVariance(osg::Object::DYNAMIC);
    lines->setUseDisplayList(false);
    lines->setUseVertexBufferObjects(true);
    lines->setVertexArray(new osg::Vec3Array);
    lines->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 0));
    lines->getOrCreateStateSet()->setAttributeAndModes(new osg::LineWidth(2.0f));
    osgManipulator::setMaterialColor(OUTLINE_COLOR, *lines);
    return lines;
}

void setLines(osg::Geometry& lines, const std::vector<osg::Vec3d>& points)
{
    auto& vertices = static_cast<osg::Vec3Array&>(*lines.getVertexArray());
    vertices.assign(points.begin(), points.end());
    vertices.dirty();
    auto& set = static_cast<osg::DrawArrays&>(*lines.getPrimitiveSet(0));
    set.setCount(static_cast<GLsizei>(vertices.size()));
    set.dirty();
    lines.dirtyBound();
}

osg::Vec4d planeOf(const osg::Matrixd& m)
{
    osg::Vec3d normal(m(1, 0), m(1, 1), m(1, 2));
    normal.normalize();
    return {normal, -(normal * m.getTrans())};
}

osg::Matrixd planePlace(const osg::Vec4d& plane, const osg::Vec3d& near, double size)
{
    osg::Vec3d normal(plane.x(), plane.y(), plane.z());
    const double length = normal.normalize();
    const osg::Vec3d middle = near - normal * (normal * near + plane.w() / length);
    return osg::Matrixd::scale(size, size, size) *
           osg::Matrixd::rotate(osg::Vec3d(0.0, 1.0, 0.0), normal) *
           osg::Matrixd::translate(middle);
}

osg::BoundingBoxd boxOf(const osg::Matrixd& m)
{
    const osg::Vec3d half =
        osg::Vec3d(std::fabs(m(0, 0)), std::fabs(m(1, 1)), std::fabs(m(2, 2))) * 0.5;
    return {m.getTrans() - half, m.getTrans() + half};
}

osg::Matrixd boxPlace(const osg::BoundingBoxd& box)
{
    return osg::Matrixd::scale(box._max - box._min) * osg::Matrixd::translate(box.center());
}

double radiusOf(const osg::Matrixd& m)
{
    double lengths[] = {rowLength(m, 0), rowLength(m, 1), rowLength(m, 2)};
    std::sort(lengths, lengths + 3);
    const bool longer = lengths[2] - lengths[1] > lengths[1] - lengths[0];
    return 0.5 * lengths[longer ? 2 : 0];
}

osg::Matrixd spherePlace(const osg::Vec3d& center, double radius)
{
    return ballPlace(center, 2.0 * radius);
}

osg::Matrixd ballPlace(const osg::Vec3d& center, double radius)
{
    return osg::Matrixd::scale(radius, radius, radius) * osg::Matrixd::translate(center);
}

} // namespace handleShapes
} // namespace osgVolumizer
