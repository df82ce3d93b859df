#pragma once

#include "../../core/cutting/Cut.h"
#include "FirstHit.h"

#include <memory>
#include <optional>

namespace osgVolumizer {
namespace picking {

/// One volume as it is seen at one time: what a pick, a probe or a selection start from.
struct VolumeView
{
    std::shared_ptr<const PickRegion> region; ///< null where nothing is drawn
    PickLook look;
    render::TimeSteps steps;
    osg::ref_ptr<const Voxels> voxels;    ///< null without any
    std::shared_ptr<const core::Cut> cut; ///< null for none

    VolumeView(const VolumeGeometry& geometry, const VolumeAppearance& appearance,
               double simulationTime);

    /// The parts of a segment (object frame) in the region of which the cut leaves at least half.
    /// \param clipPlanes see PickOptions
    std::vector<Span> spans(const Segment& segment,
                            const std::vector<osg::Vec4d>& clipPlanes) const;
    /// Whether the cut leaves anything of a box of the voxel frame, as far as is known.
    bool isKept(const core::Box3d& box) const;
    /// Whether at least half is left at a place of the voxel frame.
    bool isKeptAt(const glm::dvec3& voxel) const;

    /// Levels that there are to choose from.
    int levelCount() const;
    /// Whether values (fractions) in a range may be seen.
    bool shows(const core::ValueRange& fractions) const;
    /// The finest level of which the bricks or pages along spans have no more bytes than that; else
    /// the coarsest. `from`: none finer than that.
    /// `hidden`: what shows nothing counts, too.
    int levelWithin(const std::vector<Span>& spans, std::int64_t bytes, int from,
                    bool hidden = false) const;
    /// The same of those that boxes (voxel frame) touch.
    int levelWithin(const std::vector<core::Box3d>& boxes, std::int64_t bytes) const;
    /// The values of a level; null without voxels.
    std::unique_ptr<ValueField> fieldOf(int level) const;

    /// Change of the voxel coordinate with the object position, in a span.
    glm::dmat3 voxelPerObject(const Span& span) const;
    /// Length 1, against the direction of the segment: of the gradient, where there is one.
    glm::dvec3 normalAt(ValueField* field, const Segment& segment, const Span& span,
                        double parameter) const;

private:
    std::int64_t bytesAlong(const std::vector<Span>& spans, int level, std::int64_t most,
                            bool hidden) const;
    bool counts(const GridReader& grid, std::int64_t index) const;
};

} // namespace picking
} // namespace osgVolumizer
