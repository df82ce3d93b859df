#pragma once

#include <osg/Geometry>
#include <osgUtil/RenderLeaf>

namespace osgVolumizer {
namespace test {

/// A view along -z from the origin: device coordinates are x / 10 and y / 10, depth is -z, from 0
/// to 100.
inline osg::Matrixd boxProjection()
{
    return osg::Matrixd::ortho(-10.0, 10.0, -10.0, 10.0, 0.0, 100.0);
}

/// A leaf as cull makes it, of a drawable in the eye frame.
inline osg::ref_ptr<osgUtil::RenderLeaf> makeLeaf(osg::Drawable* drawable,
                                                  const osg::Matrixd& projection = boxProjection())
{
    return new osgUtil::RenderLeaf(drawable, new osg::RefMatrix(projection), new osg::RefMatrix,
                                   0.0f, 0);
}

/// Adds a rectangle facing the eye, as cells x cells quads of two triangles each.
inline void addRectangle(osg::Geometry& geometry, const osg::Vec2& min, const osg::Vec2& max,
                         double depth, unsigned cells = 1)
{
    auto* vertices = static_cast<osg::Vec3Array*>(geometry.getVertexArray());
    if (!vertices) geometry.setVertexArray(vertices = new osg::Vec3Array);
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto first = static_cast<unsigned>(vertices->size());
    for (unsigned y = 0; y <= cells; ++y)
        for (unsigned x = 0; x <= cells; ++x) {
            const float u = float(x) / float(cells), v = float(y) / float(cells);
            vertices->push_back({min.x() + u * (max.x() - min.x()),
                                 min.y() + v * (max.y() - min.y()), -float(depth)});
        }
    for (unsigned y = 0; y < cells; ++y)
        for (unsigned x = 0; x < cells; ++x) {
            const unsigned a = first + y * (cells + 1) + x, b = a + cells + 1;
            for (unsigned i : {a, a + 1, b, b, a + 1, b + 1})
                indices->push_back(i);
        }
    geometry.addPrimitiveSet(indices);
    geometry.dirtyBound();
}

inline osg::ref_ptr<osg::Geometry> makeRectangle(const osg::Vec2& min, const osg::Vec2& max,
                                                 double depth, unsigned cells = 1)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    addRectangle(*geometry, min, max, depth, cells);
    return geometry;
}

} // namespace test
} // namespace osgVolumizer
