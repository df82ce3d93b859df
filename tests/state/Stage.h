#pragma once

#include "Framebuffer.h"
#include "StateRow.h"

#include <osg/Group>

#include <memory>

namespace osgVolumizer {
namespace test {

/// What is drawn under a state, or by a camera.
enum class Content
{
    SLABS,
    SLICES,
    MAXIMUM,      ///< a ray function that gathers
    SURFACE,      ///< a translucent surface inside a volume, the state above both
    BARE_SURFACE, ///< the same, the state above the volume alone
    OVERLAP       ///< two volumes
};

std::string nameOf(Content content);

/// Largest difference of any pixel in the first colours or depth; infinite where stencils differ.
double difference(const FramebufferContents& a, const FramebufferContents& b);

/// One scene in two versions: with volumes, and with translucent geometry that looks the same.
/// Rays are parallel and volumes have two colours, in columns, so that flat geometry can. Before
/// both opaque geometry is drawn, behind and in front, and the stencil of the right half set to 1;
/// after both, geometry in OSG's default state, and some that makes pixels blue where the stencil
/// is 1.
class Stage
{
public:
    static constexpr int SIZE = 48; ///< pixels each way

    explicit Stage(Content content, const FramebufferFormat& format = FramebufferFormat());
    ~Stage();

    /// What both versions are drawn to from now on, in the contexts that they have.
    void setFormat(const FramebufferFormat& format);
    /// What is done to the cameras of both from now on, and what to their scenes; either may be
    /// null.
    struct Arrangement
    {
        std::function<void(osg::Camera&)> camera;
        std::function<osg::ref_ptr<osg::Node>(osg::Node*)> scene;
    };
    void arrange(const Arrangement& arrangement);
    /// Neither volumes nor what stands for them.
    FramebufferContents bare();
    /// With several samples a pixel what is merged with volumes has one, as they do: states
    /// of surfaces that concern samples have no effect.
    void setSurfacesBare(bool on) { _surfacesBare = on; }

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
    FramebufferContents show(Version& version);

    Content _content;
    FramebufferFormat _format;
    Arrangement _arrangement;
    bool _surfacesBare = false;
    std::unique_ptr<Version> _volume, _geometry;
};

} // namespace test
} // namespace osgVolumizer
