#pragma once

#include "../../core/geometry/TetraSet.h"

#include <osg/TextureBuffer>

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
    unsigned scalarCount = 0; ///< of the geometry, that the scalars are of
    std::size_t cellCount = 0;
    int facesBegin = 0, gridBegin = 0; ///< words
    glm::ivec3 gridSize{1};
    glm::vec3 gridMin{0.0f}, gridScale{1.0f};                  ///< frame; cells per frame unit
    std::shared_ptr<const std::vector<std::uint32_t>> numbers; ///< of tetrahedra, in the set
    bool isOdd = false;
    std::string oddities; ///< see core::TetraGraph

    std::vector<osg::TextureBuffer*> all() const;
    std::size_t bytes() const; ///< on the card
    /// Texels of the largest buffer.
    std::size_t largestBuffer() const;
};

/// \param places whether voxel coordinates are needed
std::shared_ptr<const TetraTextures> makeTetraTextures(const core::TetraSet& set, bool places);
/// The same, filled with the scalars that a geometry has now.
std::shared_ptr<const TetraTextures> withScalars(const TetraTextures& textures,
                                                 const VolumeGeometry& geometry);

} // namespace render
} // namespace osgVolumizer
