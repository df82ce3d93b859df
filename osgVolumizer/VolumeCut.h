#pragma once

#include "CutRegion.h"
#include "RenderData.h"
#include "core/RecencyCache.h"
#include "core/cutting/Cut.h"

#include <osg/Object>

#include <glm/vec3.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace osgVolumizer {

/// What is left of the volumes of an appearance (see VolumeAppearance::setCut()): all that lies in
/// every one of its regions. What is cut away is neither read nor marched, nor is it picked.
/// Appearances may share one.
///
/// Half-spaces, boxes, and surfaces that are convex and have no more than 32 faces cut exactly, as
/// osg::ClipPlanes do, 64 planes in all; so do spheres and what lies outside of boxes, eight in
/// all, to second order in the sampling period. All others, surfaces and masks are met to second
/// order in the distance of samples of a grid (see setResolution()), which rounds edges by about
/// that. Of soft cuts, deformed volumes, and slices that follow a cut, eight planes are exact. To
/// be changed between frames.
class OSGVOLUMIZER_EXPORT VolumeCut : public osg::Object
{
public:
    META_Object(osgVolumizer, VolumeCut);

    VolumeCut() = default;
    /// Shares masks with `o`; has its own with CopyOp::DEEP_COPY_OBJECTS.
    VolumeCut(const VolumeCut& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Adds a region, or puts it in the place of another. Refused as by CutRegion::validate(), and
    /// (INDEX_OUT_OF_RANGE) where there is none of that number: nothing is changed.
    ReportedStatus addRegion(const CutRegion& region);
    ReportedStatus setRegion(unsigned number, const CutRegion& region);
    ReportedStatus removeRegion(unsigned number);
    void clear();
    unsigned getNumRegions() const { return static_cast<unsigned>(_regions.size()); }
    /// Expects a number below getNumRegions().
    const CutRegion& getRegion(unsigned number) const { return _regions[number]; }

    /// Width, in object units, over which the volume fades from all to nothing, half of it to each
    /// side; 0 (default): sharp. Not negative, finite.
    ReportedStatus setSoftness(double objectUnits);
    double getSoftness() const { return _softness; }
    /// Samples of the grid along the longest axis of the voxels, from 8 to 512; 0 (default): 128,
    /// or as many as a mask has, up to 256. Four bytes each, in memory and on the card. It is made
    /// in the first frame after a change, some 0.1 s for 128^3.
    ReportedStatus setResolution(int samples);
    int getResolution() const { return _resolution; }
    /// The values of a mask have changed.
    void dirty() { ++_modifiedCount; }
    /// Grows with every change. Thread safe.
    unsigned getModifiedCount() const { return _modifiedCount; }

    /// The cut for voxels that fill a box (frame of the regions); null where nothing is cut. Made
    /// once for each state. Thread safe.
    /// \param anyPlanes else no more than MOST_SHAPES, as where it is soft
    std::shared_ptr<const core::Cut> cutOf(const core::Box3d& box, bool anyPlanes = true) const;

    void resizeGLObjectBuffers(unsigned int maximum) override
    {
        _renderData.resizeGLObjectBuffers(maximum);
    }
    void releaseGLObjects(osg::State* state = nullptr) const override
    {
        _renderData.releaseGLObjects(state);
    }

    /// Shapes of a core::Cut, and planes where there may not be any number, that are not put into
    /// its grid; and planes in any case.
    static constexpr std::size_t MOST_SHAPES = 8, MOST_PLANES = 64;
    /// Faces of a convex surface that is cut by planes.
    static constexpr std::size_t MOST_FACES = 32;

protected:
    ~VolumeCut() override = default;

private:
    friend struct RenderDataAccess;
    struct Key
    {
        core::Box3d box;
        bool anyPlanes;
        unsigned modifiedCount;
        bool operator==(const Key& o) const
        {
            return box == o.box && anyPlanes == o.anyPlanes && modifiedCount == o.modifiedCount;
        }
    };
    using CutPtr = std::shared_ptr<const core::Cut>;
    std::shared_ptr<const core::Cut> make(core::Box3d box, bool anyPlanes) const;
    glm::ivec3 samplesFor(const core::Box3d& box) const;

    std::vector<CutRegion> _regions;
    double _softness = 0.0;
    int _resolution = 0;
    std::atomic<unsigned> _modifiedCount{0};
    mutable std::mutex _mutex; // of the next
    mutable core::RecencyCache<Key, CutPtr> _made{32};
    mutable RenderDataSlot _renderData; // the grid's texture
};

} // namespace osgVolumizer
