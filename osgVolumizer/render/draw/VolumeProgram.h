#pragma once

#include "../context/LeafState.h"

#include "ProgramFeatures.h"

#include <osg/Program>
#include <osg/StateSet>

#include <vector>

namespace osgVolumizer {
namespace render {

/// The state that a volume with these features is drawn with: program, blending, depth test without
/// writes, transparent bin. Shared by all volumes, views and contexts. Thread safe.
osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features);
/// The same for several volumes that are marched together: `features` are those of the march,
/// each member has its own.
osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features,
                                           const std::vector<ProgramFeatures>& members);
/// A compute shader that does the same, in the pixels of an `area`, to the image `target`: see
/// runCompute(). The header is computeHeader() and defines TARGET_FORMAT.
osg::ref_ptr<osg::Program> makeComputeProgram(const std::string& header,
                                              const ProgramFeatures& features,
                                              const std::vector<ProgramFeatures>& members);
/// Below that state: a depth test other than the usual one.
osg::ref_ptr<osg::StateSet> depthTestStateSet(const DepthTest& test);
/// Draws what a ray function gathered, of values or of colours, at once.
osg::ref_ptr<osg::Program> makeResolveProgram(VolumeAppearance::RayFunction function, bool rgba);
/// Fills the pixels of a coarse image: see CoarseImage.
osg::ref_ptr<osg::Program> makeFillProgram();

} // namespace render
} // namespace osgVolumizer
