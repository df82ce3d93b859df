#pragma once

#include <osg/Drawable>
#include <osg/Geometry>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Draws some triangles of a geometry by indices of our own, with all of its arrays.
class TrianglesOfGeometry : public osg::Drawable
{
public:
    using Indices = std::shared_ptr<const std::vector<unsigned>>; ///< three a triangle

    TrianglesOfGeometry(const osg::Geometry* geometry, Indices indices);
    osg::Object* cloneType() const override { return new TrianglesOfGeometry(nullptr, nullptr); }
    osg::Object* clone(const osg::CopyOp&) const override { return cloneType(); }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "TrianglesOfGeometry"; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<const osg::Geometry> _geometry;
    Indices _indices;
};

} // namespace render
} // namespace osgVolumizer
