#pragma once

#include "../context/Uniforms.h"

#include <osg/State>
#include <osg/Texture3D>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace render {

/// What a shader has to know of a core::Cut, in its frame moved to the middle of the volume.
struct CutLook
{
    glm::dmat4 fromVolume{1.0}; ///< voxel coordinate, or without voxels frame, -> cut
    std::vector<glm::vec4> planes;
    std::vector<glm::vec4> centers;   ///< of shapes, and the radius
    std::vector<glm::vec4> halfSizes; ///< of shapes; 1 where the inside is kept, else -1
    float sharpness = 0.0f;           ///< 1 over the width of fading; 0: sharp
    osg::ref_ptr<osg::Texture3D> field;
    glm::vec3 fieldScale{0.0f}, fieldOffset{0.0f}; ///< cut -> texture coordinate
    unsigned id = 0;                               ///< of the cut; 0: none
};

void setCut(const Uniforms& uniforms, const CutLook& cut);
/// Applies the grid, where there is one, to a texture unit; false, reported once, where the card
/// refuses it: what it is for is not drawn.
bool applyCutField(osg::State& state, const CutLook& cut, unsigned unit);

} // namespace render
} // namespace osgVolumizer
