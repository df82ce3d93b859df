#pragma once

#include "../context/LeafState.h"

#include "ProgramFeatures.h"

#include <osg/Program>
#include <osg/StateSet>

namespace osgVolumizer {
namespace render {

/// Whether slabs draw how many samples they take, added up in the red channel of a float
/// framebuffer, instead of colours: for tests and for tuning. Off by default.
void setSampleCounting(bool on);
bool sampleCounting();

/// The state that a volume with these features is drawn with: program, blending, depth test without
/// writes, transparent bin. Shared by all volumes, views and contexts. Thread safe.
osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features);
/// Below that state: a depth test other than the usual one.
osg::ref_ptr<osg::StateSet> depthTestStateSet(const DepthTest& test);
/// Draws the layer of a volume that gathers(); depends on ray function and rgba only.
osg::ref_ptr<osg::Program> makeResolveProgram(const ProgramFeatures& features);

} // namespace render
} // namespace osgVolumizer
