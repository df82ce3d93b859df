#pragma once

#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/Vec3d>
#include <osg/Vec4>
#include <osg/Vec4d>
#include <osgManipulator/Dragger>

#include <vector>

/// osgManipulator's draggers, put together, each in a frame of its own that a dragger's matrix
/// leads from.
namespace osgVolumizer {
namespace handleShapes {

const osg::Vec4 OUTLINE_COLOR(0.95f, 0.85f, 0.3f, 1.0f);
const osg::Vec4 POINT_COLOR(0.2f, 0.8f, 0.95f, 1.0f);

/// Draggers that move as one.
class MixedDragger : public osgManipulator::CompositeDragger
{
public:
    /// Expects draggers with geometry, whose own matrices become `scale`.
    void add(osgManipulator::Dragger* dragger, double scale);
};

/// The plane y = 0, seen as the square of side 1 about the origin: an arrow along its normal, and
/// rings to turn it by.
osg::ref_ptr<osgManipulator::Dragger> makePlaneDragger();
/// The box from -0.5 to 0.5: tabs on its faces, and faces that slide.
osg::ref_ptr<osgManipulator::Dragger> makeBoxDragger();
/// The sphere of radius 0.5: arrows move it, boxes where the axes leave it change its size, each
/// along its own axis (see radiusOf()).
osg::ref_ptr<osgManipulator::Dragger> makeSphereDragger();
/// Arrows along the axes, and rings to turn by, within a radius of 1.
osg::ref_ptr<osgManipulator::Dragger> makePartDragger();
/// A ball of radius 1 about the origin that moves across the line of sight.
osg::ref_ptr<osgManipulator::Dragger> makePointDragger(const osg::Vec4& color = POINT_COLOR);

/// Lines that no pointer hits; to be changed between frames by setLines().
osg::ref_ptr<osg::Geometry> makeLines();
/// Each two points are a line.
void setLines(osg::Geometry& lines, const std::vector<osg::Vec3d>& points);

/// The plane, normal of length 1, that a plane dragger's matrix says.
osg::Vec4d planeOf(const osg::Matrixd& matrix);
/// The other way round: a square of side `size`, as near as can be to a point.
osg::Matrixd planePlace(const osg::Vec4d& plane, const osg::Vec3d& near, double size);
/// Of a matrix that neither turns nor shears.
osg::BoundingBoxd boxOf(const osg::Matrixd& matrix);
osg::Matrixd boxPlace(const osg::BoundingBoxd& box);
/// The radius that a sphere dragger's matrix says: along the axis that differs from the other two.
double radiusOf(const osg::Matrixd& matrix);
osg::Matrixd spherePlace(const osg::Vec3d& center, double radius);
/// Of a point dragger, or a part's.
osg::Matrixd ballPlace(const osg::Vec3d& center, double radius);

} // namespace handleShapes
} // namespace osgVolumizer
