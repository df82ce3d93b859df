#include "CurvedStrip.h"

#include "core/NumberRule.h"
#include "core/Text.h"

namespace osgVolumizer {

namespace CurvedStrips {

osg::ref_ptr<osg::Geometry> stripOf(osg::Vec3dArray* positions)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions);
    geometry->addPrimitiveSet(
        new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(positions->size())));
    return geometry;
}

Status invalid(const std::string& text)
{
    return {ErrorCode::VALUE_INVALID, "curved strip: " + text};
}

Status check(const std::vector<osg::Vec3d>& line, const osg::Vec3d& direction, double width)
{
    if (line.size() < 2)
        return invalid("the line has " + std::to_string(line.size()) + " points, expected two");
    if (!core::LENGTH.holds(width))
        return invalid("width is " + core::formatNumber(width) + ", expected " +
                       core::LENGTH.expected);
    if (!core::LENGTH.holds(direction.length()))
        return invalid("the direction has length " + core::formatNumber(direction.length()) +
                       ", expected " + core::LENGTH.expected);
    for (std::size_t i = 0; i < line.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!core::POSITION.holds(line[i][axis]))
                return invalid("point " + std::to_string(i) + " has " +
                               core::formatNumber(line[i][axis]) + ", expected " +
                               core::POSITION.expected);
    return {};
}

} // namespace CurvedStrips

Result<CurvedStrip> makeCurvedStrip(const std::vector<osg::Vec3d>& line,
                                    const osg::Vec3d& direction, double width)
{
    if (Status s = CurvedStrips::check(line, direction, width); !s.ok()) return s;
    const osg::Vec3d along = direction / direction.length(), half = along * (0.5 * width);
    osg::ref_ptr<osg::Vec3dArray> places = new osg::Vec3dArray, flat = new osg::Vec3dArray;
    osg::Vec3d at; // of the line, laid flat
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0) {
            const osg::Vec3d step = line[i] - line[i - 1];
            const double rise = step * along, advance = (step - along * rise).length();
            if (!(advance > 0.0))
                return CurvedStrips::invalid("from point " + std::to_string(i - 1) +
                                             " the line goes along the direction");
            at += osg::Vec3d(advance, rise, 0.0);
        }
        for (const double side : {-1.0, 1.0}) {
            places->push_back(line[i] + half * side);
            flat->push_back(at + osg::Vec3d(0.0, 0.5 * side * width, 0.0));
        }
    }
    CurvedStrip strip;
    strip.inPlace = CurvedStrips::stripOf(places);
    strip.unrolled = CurvedStrips::stripOf(flat);
    strip.unrolled->setTexCoordArray(0, places);
    strip.length = at.x();
    return strip;
}

} // namespace osgVolumizer
