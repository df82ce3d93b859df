#pragma once

#include "../context/ContextRefusals.h"
#include "../draw/Accumulation.h"

#include <osg/Drawable>

#include <glm/vec4.hpp>

#include <string>

namespace osgVolumizer {
namespace render {

/// A step of sorting surfaces with volumes, as a leaf among theirs: what the ways that do have in
/// common.
class SortingLeaf : public osg::Drawable
{
public:
    osg::Object* clone(const osg::CopyOp&) const override { return cloneType(); }
    const char* libraryName() const override { return "osgVolumizer"; }

protected:
    /// \param area window rectangle: x, y, width, height
    SortingLeaf(Accumulation* accumulation, const glm::ivec4& area);

    /// In the frame that finds that the card has no memory for the buffers, surfaces are drawn
    /// after the volumes; from the next one on they are merged in another way. \param skips whether
    /// what follows this step is not drawn, or drawn again
    void drawWithout(osg::State& state, Refusal refusal, const std::string& message,
                     bool skips) const;

    osg::ref_ptr<Accumulation> _accumulation;
    glm::ivec4 _area;
};

} // namespace render
} // namespace osgVolumizer
