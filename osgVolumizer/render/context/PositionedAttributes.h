#pragma once

#include <osgUtil/RenderStage>

#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The attributes of a type that have a place in a stage, lights and clip planes, with the matrix
/// from where they are to the eye frame: in the order in which OpenGL is told of them, so that the
/// last one of a number counts.
template <class Attribute>
std::vector<std::pair<const Attribute*, osg::Matrixd>>
positionedAttributes(osgUtil::RenderStage& stage)
{
    std::vector<std::pair<const Attribute*, osg::Matrixd>> found;
    const auto append = [&](osgUtil::PositionalStateContainer* container,
                            const osg::Matrixd& after) {
        if (!container) return;
        for (const auto& entry : container->getAttrMatrixList())
            if (const auto* attribute = dynamic_cast<const Attribute*>(entry.first.get()))
                found.emplace_back(attribute,
                                   entry.second ? osg::Matrixd(*entry.second) * after : after);
    };
    append(stage.getInheritedPositionalStateContainer(),
           stage.getInheritedPositionalStateContainerMatrix());
    append(stage.getPositionalStateContainer(), osg::Matrixd::identity());
    return found;
}

} // namespace render
} // namespace osgVolumizer
