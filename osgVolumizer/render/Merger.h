#pragma once

#include "GroupComposer.h"

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/observer_ptr>
#include <osgUtil/RenderBin>

#include <memory>
#include <vector>

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Collects the volumes of one transparent bin in one view, and, once every leaf and the final near
/// and far are known, replaces their leaves by drawn ones in depth order with everything else in
/// the bin. One per bin and cull; a sort callback that was there before still runs first.
class Merger : public osgUtil::RenderBin::SortCallback
{
public:
    /// The merger of a bin, installed on the first call.
    static Merger* of(osgUtil::RenderBin& bin, osgUtil::CullVisitor& visitor);

    void add(std::unique_ptr<VolumeInstance> volume) { _volumes.push_back(std::move(volume)); }
    void sortImplementation(osgUtil::RenderBin* bin) override;

private:
    using LeafList = osgUtil::RenderBin::RenderLeafList;

    std::vector<VolumeInstance*> visibleVolumes(const LeafList& leaves) const;
    osg::ref_ptr<Accumulation> makeAccumulation() const;
    void report(const FrameCounts& counts) const;

    std::vector<std::unique_ptr<VolumeInstance>> _volumes;
    osg::ref_ptr<osgUtil::RenderBin::SortCallback> _chained;
    osg::observer_ptr<const osg::Camera> _camera; ///< holds the bin, and so this
    osg::ref_ptr<const osg::FrameStamp> _frameStamp;
    osg::ref_ptr<const osg::Viewport> _viewport;
};

} // namespace render
} // namespace osgVolumizer
