#pragma once

#include "Accumulation.h"

namespace osgVolumizer {
namespace render {

/// The leaf that calls one of Accumulation's steps.
class AccumulationLeaf : public osg::Drawable
{
public:
    enum Step
    {
        BEGIN,
        END,
        BEGIN_SPLIT,
        END_SPLIT
    };

    AccumulationLeaf(Accumulation* accumulation, Step step, const glm::ivec4& area);
    osg::Object* cloneType() const override
    {
        return new AccumulationLeaf(nullptr, BEGIN, glm::ivec4(0));
    }
    osg::Object* clone(const osg::CopyOp&) const override { return cloneType(); }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "AccumulationLeaf"; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    osg::ref_ptr<Accumulation> _accumulation;
    Step _step;
    glm::ivec4 _area;
};

/// A leaf for a step, among the leaves of the same bin and view as `beside`.
osgUtil::RenderLeaf* accumulationLeaf(Accumulation& accumulation, AccumulationLeaf::Step step,
                                      const osgUtil::RenderLeaf& beside, const glm::ivec4& area);

} // namespace render
} // namespace osgVolumizer
