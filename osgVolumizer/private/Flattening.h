#pragma once

#include <osg/NodeVisitor>

namespace osgVolumizer {

/// osgUtil::Optimizer's FLATTEN_STATIC_TRANSFORMS_DUPLICATING_SHARED_SUBGRAPHS (part of its
/// ALL_OPTIMIZATIONS) replaces every STATIC transform by a group, asks no drawable whether it can
/// be transformed, and multiplies the vertices of every osg::Geometry below by what it took out.
/// A volume is no osg::Geometry, and its lengths, opacity unit and voxels belong to one frame, so
/// it gets the transforms back, as one above it, and what is below it is left alone.
/// (Below a transform that moves, under one that was taken out, OSG exchanges the two for meshes;
/// so does this for volumes.)
///
/// To be called by accept(), before `node` is visited: true where `visitor` is of that kind, and so
/// must not visit the node.
bool keepsTransforms(osg::Node& node, osg::NodeVisitor& visitor);

} // namespace osgVolumizer
