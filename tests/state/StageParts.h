#pragma once

#include <osgVolumizer/VolumeAppearance.h>

#include <osg/Geometry>
#include <osg/Group>

namespace osgVolumizer {
namespace test {

/// A rectangle at a depth that faces the eye, with all that fixed function can ask for.
osg::ref_ptr<osg::Geometry> rectangle(const osg::Vec2& low, const osg::Vec2& high, float z,
                                      const osg::Vec4& color, bool translucent = false);

/// Opaque geometry behind and in front of what is tested.
osg::ref_ptr<osg::Group> surroundings();
/// Geometry that leaves nothing but the stencil, before all else...
osg::ref_ptr<osg::Geometry> stencilWriter();
/// ...and that makes blue, after all else, where the stencil is 1.
osg::ref_ptr<osg::Geometry> stencilWitness();
/// Geometry in OSG's default state that is drawn after what is tested: beside, in front, and
/// translucent.
osg::ref_ptr<osg::Group> afterwards();

/// The two colours of a volume: of its lower left part, and of the rest.
struct Colors
{
    osg::Vec4 corner, rest;
};

/// Height of the middle of what is tested, which has no symmetry up and down.
constexpr float UP = 2.0f;
/// A volume about (0, UP, z).
osg::ref_ptr<osg::Node> box(VolumeAppearance::RayFunction function,
                            VolumeAppearance::Technique technique, const Colors& colors, float z);
/// Adds what looks like one from the front, or like a layer of it.
void addLayer(osg::Group& group, float z, const Colors& colors);

} // namespace test
} // namespace osgVolumizer
