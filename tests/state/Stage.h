#pragma once

#include "Framebuffer.h"
#include "StateRow.h"

#include <osg/Group>

#include <memory>

namespace osgVolumizer {
namespace test {

/// What is drawn under a state.
enum class Content
{
    SLABS,
    SLICES,
    MAXIMUM,      ///< a ray function that gathers
    SURFACE,      ///< a translucent surface inside a volume, the state above both
    BARE_SURFACE, ///< the same, the state above the volume alone
    OVERLAP       ///< two volumes
};

/// One scene in two versions: with volumes, and with translucent geometry that looks the same.
/// Rays are parallel and volumes have two colours, in columns, so that flat geometry can. Before
/// both opaque geometry is drawn, behind and in front, and the stencil of the right half set to 1;
/// after both, geometry in OSG's default state, and some that makes pixels blue where the stencil
/// is 1.
class Stage
{
public:
    static constexpr int SIZE = 48; ///< pixels each way

    Stage(Content content, Target target);
    ~Stage();

    /// Under a row's state, or none for null.
    FramebufferContents volume(const StateRow* row, unsigned value);
    /// What the volume has to look like where the state does, and does not, concern volumes; it
    /// always concerns surfaces that it is above.
    FramebufferContents geometry(const StateRow* row, unsigned value, bool concernsVolumes);
    /// Forgets what the contexts were left with.
    void restart();

private:
    struct Version;

    void makeMeshes();
    osg::ref_ptr<osg::Group> volumes() const;
    FramebufferContents show(std::unique_ptr<Version>& version);

    Content _content;
    Target _target;
    std::unique_ptr<Version> _volume, _geometry;
};

} // namespace test
} // namespace osgVolumizer
