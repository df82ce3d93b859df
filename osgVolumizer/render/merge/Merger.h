#pragma once

#include "../draw/Accumulation.h"
#include "../volume/VolumeInstance.h"
#include "FrameCounts.h"

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/observer_ptr>
#include <osgUtil/RenderBin>
#include <osgUtil/RenderLeaf>

#include <memory>
#include <vector>

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// Collects the volumes of one transparent bin in one view, and, once every leaf and the final near
/// and far are known, replaces their leaves by drawn ones in depth order with everything else in
/// the bin. A sort callback that was there before still runs first; one that is installed later in
/// the same cull has to call the one that it finds.
///
/// Bins that are sorted by depth and nested directly in each other are one: the outermost has the
/// merger, and it draws the leaves of all as soon as one shows a volume. Other bins state an order
/// of their own, which stays.
class Merger : public osgUtil::RenderBin::SortCallback
{
public:
    /// The merger of a bin, and of those it is nested in, installed on the first call.
    static Merger* of(osgUtil::RenderBin& bin, osgUtil::CullVisitor& visitor);

    void add(std::unique_ptr<VolumeInstance> volume) { _volumes.push_back(std::move(volume)); }
    void sortImplementation(osgUtil::RenderBin* bin) override;

private:
    using BinLeaves = osgUtil::RenderBin::RenderLeafList;

    std::vector<VolumeInstance*> visibleVolumes(const std::vector<osgUtil::RenderBin*>& bins) const;
    glm::ivec4 viewport() const;
    void merge(const osgUtil::RenderBin& bin, BinLeaves& leaves,
               const std::vector<VolumeInstance*>& visible, FrameCounts& counts);
    osg::ref_ptr<Accumulation> makeAccumulation() const;
    void report(const FrameCounts& counts) const;

    std::vector<std::unique_ptr<VolumeInstance>> _volumes;
    osg::ref_ptr<osgUtil::RenderBin::SortCallback> _chained;
    /// OSG lets go of the leaves of a stage once it is drawn, but looks at the last one of them
    /// before it draws the next stage.
    osg::ref_ptr<osgUtil::RenderLeaf> _last;
    osg::observer_ptr<const osg::Camera> _camera; ///< holds the bin, and so this
    osg::ref_ptr<const osg::FrameStamp> _frameStamp;
    osg::ref_ptr<const osg::Viewport> _viewport; ///< of the volume that came first
    int _textureUnits = 0;
    unsigned _contextId = 0;
    bool _oneViewport = true; ///< is that of all volumes
};

} // namespace render
} // namespace osgVolumizer
