#pragma once

#include "../context/Uniforms.h"
#include "AccumulationBuffers.h"
#include "PixelRays.h"
#include "VolumePart.h"

#include <osg/State>

namespace osgVolumizer {
namespace render {

/// The texture unit of a cut's grid: after those of paints.
unsigned cutUnitOf(const ProgramFeatures& features);

/// Tells the program in force which texture units its samplers are.
void setSamplers(const Uniforms& uniforms);

/// Gives the program in force all that it needs of a part but its voxels, table and paints: values,
/// lights and the depths that segments end at. Call in the draw thread.
void setUniforms(osg::State& state, const Uniforms& uniforms, const VolumePart& part,
                 const PixelRays& rays, const glm::dmat4& frameToEye,
                 const AccumulationBuffers& buffers);

/// The first of the units that tetrahedra take.
unsigned tetraUnitOf(const ProgramFeatures& features);
/// What rays walk through, from a texture unit on; false, reported once, where the card refuses it.
bool setTetrahedra(osg::State& state, const Uniforms& uniforms, const VolumeLook& look,
                   unsigned unit);

} // namespace render
} // namespace osgVolumizer
