#include "Flattening.h"

#include <osg/MatrixTransform>
#include <osgUtil/Optimizer>

namespace osgVolumizer {

namespace {

using FlatteningVisitor =
    osgUtil::Optimizer::FlattenStaticTransformsDuplicatingSharedSubgraphsVisitor;

/// The visitor keeps to itself and to its heirs what it has taken out so far.
struct Heir : FlatteningVisitor
{
    static const std::vector<osg::Matrix>& matricesOf(const FlatteningVisitor& visitor)
    {
        return visitor.*(&Heir::_matrixStack);
    }
};

} // namespace

bool keepsTransforms(osg::Node& node, osg::NodeVisitor& visitor)
{
    if (visitor.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false; // no cull
    const auto* flattening = dynamic_cast<const FlatteningVisitor*>(&visitor);
    if (!flattening) return false;
    const std::vector<osg::Matrix>& matrices = Heir::matricesOf(*flattening);
    const osg::NodePath& path = visitor.getNodePath();
    osg::Group* parent = path.empty() ? nullptr : path.back()->asGroup();
    if (matrices.empty() || !parent) return true;
    // Below a transform that was taken out all is a copy with one parent.
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrices.back());
    transform->setDataVariance(osg::Object::DYNAMIC); // or it would be taken out next
    transform->addChild(&node);
    parent->replaceChild(&node, transform);
    return true;
}

} // namespace osgVolumizer
