#pragma once

#include <osg/BlendFunc>
#include <osg/Geometry>

#include <array>

namespace osgVolumizer {
namespace support {

/// A flat quadrilateral of one colour (straight RGBA), corners in order around it, without normals.
/// `translucent` blends it and puts it in OSG's transparent bin.
inline osg::ref_ptr<osg::Geometry> makeQuad(const std::array<osg::Vec3, 4>& corners,
                                            const osg::Vec4& color, bool translucent = false)
{
    osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    quad->setVertexArray(new osg::Vec3Array(corners.begin(), corners.end()));
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
    (*colors)[0] = color;
    quad->setColorArray(colors, osg::Array::BIND_OVERALL);
    quad->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    if (translucent) {
        osg::StateSet* state = quad->getOrCreateStateSet();
        // Alpha accumulates as coverage does; OSG's default would square it.
        state->setAttributeAndModes(new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                                                       GL_ONE_MINUS_SRC_ALPHA),
                                    osg::StateAttribute::ON);
        state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    }
    return quad;
}

} // namespace support
} // namespace osgVolumizer
