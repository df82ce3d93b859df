#pragma once

#include "../../core/geometry/TetraSet.h"

#include <osg/TextureBuffer>
#include <osg/Vec2d>

#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <vector>

namespace osgVolumizer {
class VolumeGeometry;

namespace render {

/// A core::TetraGraph, and what fills its tetrahedra, as buffer textures. Immutable once made.
struct TetraTextures
{
    osg::ref_ptr<osg::TextureBuffer> graph;     ///< unsigned words
    osg::ref_ptr<osg::TextureBuffer> positions; ///< frame
    osg::ref_ptr<osg::TextureBuffer> places;    ///< voxel coordinates of vertices; or null
    osg::ref_ptr<osg::TextureBuffer> colors;    ///< straight RGBA of vertices; or null
    osg::ref_ptr<osg::TextureBuffer> fields;    ///< user values, one texel each; or null
    /// Fractions of the range of scalars, of vertices or tetrahedra; 3e38: none. Or null.
    osg::ref_ptr<osg::TextureBuffer> scalars;
    unsigned scalarCount = 0;   ///< of the geometry, that the scalars are of
    bool ofCells = false;       ///< scalars
    osg::Vec2d range{0.0, 1.0}; ///< of scalars
    std::size_t cellCount = 0;
    std::size_t vertexCount = 0;
    osg::ref_ptr<osg::TextureBuffer> boxes; ///< of outer faces: core::TetraGraph::boxes
    int facesBegin = 0;                     ///< words
    int faceCount = 0, leafCount = 1, leafFaces = 1;
    float size = 1.0f; ///< frame; longest side of the bounds
    std::shared_ptr<const std::vector<std::uint32_t>> numbers; ///< of tetrahedra, in the set
    bool isOdd = false;
    std::string oddities; ///< see core::TetraGraph

    std::vector<osg::TextureBuffer*> all() const;
    std::size_t bytes() const; ///< on the card
};

/// Null where there is more than an osg::Image can hold: 16 million vertices, or some 10 million
/// tetrahedra. \param places whether voxel coordinates are needed
std::shared_ptr<const TetraTextures> makeTetraTextures(const core::TetraSet& set, bool places);
/// The same, filled with the scalars that a geometry has now.
std::shared_ptr<const TetraTextures> withScalars(const TetraTextures& textures,
                                                 const VolumeGeometry& geometry);

} // namespace render
} // namespace osgVolumizer
