#pragma once

#include <osg/Referenced>
#include <osg/State>
#include <osg/ref_ptr>

#include <atomic>
#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A texture of voxels in each context that has drawn it, and who needs it how much: what a budget
/// counts and takes away. Thread safe.
class ResidentTexture : public osg::Referenced
{
public:
    virtual bool isIn(unsigned contextId) const = 0;
    /// In each of those contexts: of the texels as they are uploaded.
    virtual std::int64_t bytes() const = 0;

    /// \param priority among what the same frame draws; the larger, the longer it stays
    void setUse(unsigned frame, float priority)
    {
        _lastFrame = frame;
        _priority = priority;
    }
    /// The frame that last asked for it; 0 before any has.
    unsigned lastFrame() const { return _lastFrame; }
    float priority() const { return _priority; }

    virtual void resizeGLObjectBuffers(unsigned int maximum) = 0;
    /// Of one context, or of all where `state` is null. It is made again when it is next drawn.
    virtual void releaseGLObjects(osg::State* state) = 0;

protected:
    ~ResidentTexture() override = default;

private:
    std::atomic<unsigned> _lastFrame{0};
    std::atomic<float> _priority{0.0f};
};

/// Releases textures in the context of a state until those that are left have no more bytes than
/// there is room for: first those that no frame has asked for longest, and of the same frame the
/// least important.
void keepWithin(std::int64_t room, const std::vector<osg::ref_ptr<ResidentTexture>>& textures,
                osg::State& state);

} // namespace render
} // namespace osgVolumizer
