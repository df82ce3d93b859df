#pragma once

#include "VoxelSource.h"

#include <functional>
#include <memory>
#include <vector>

namespace osgVolumizer {

/// Time steps from a source each, which is opened when it is first read, and closed again when
/// others have been read since: a simulation's files, or what an application makes of a number.
/// All must have the size, type, components and levels of the first; spacing, origin and axes are
/// the first one's. Sources of one level get coarser ones by readThinned().
class OSGVOLUMIZER_EXPORT VoxelSeries : public VoxelSource
{
public:
    META_Object(osgVolumizer, VoxelSeries);

    using Opener = std::function<Result<osg::ref_ptr<VoxelSource>>(int step)>;
    /// Sources that are open at a time; fewer where they are in memory, and together more than a
    /// quarter of the paging budget: but always two.
    static constexpr int MOST_OPEN = 64;

    VoxelSeries() = default;
    /// Shares all.
    VoxelSeries(const VoxelSeries& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Opens step 0. `opener` is called from any thread, for several steps at once, and for a step
    /// again once that was closed. Refuses (VALUE_INVALID) fewer steps than one, and what opener
    /// and the description of step 0 are refused for; the old steps then stay.
    ReportedStatus setSteps(int count, Opener opener);
    /// Sources that stay open.
    ReportedStatus setSteps(const std::vector<osg::ref_ptr<VoxelSource>>& sources);

    Description describe() const override;
    Status read(const core::Box3i& region, void* destination) const override;
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override;
    int levelCount() const override;
    Status readLevel(int level, const core::Box3i& region, void* destination) const override;
    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override;
    int pageSize() const override;
    int stepCount() const override;
    /// FILE_UNREADABLE, SIZE_MISMATCH and what the opener says where a step cannot be opened.
    Status readStep(int step, int level, const core::Box3i& region,
                    void* destination) const override;
    /// Of a step that is open.
    std::optional<std::pair<double, double>> stepRange(int step, int level,
                                                       const core::Box3i& region) const override;

protected:
    ~VoxelSeries() override = default;

private:
    struct Steps;
    std::shared_ptr<Steps> _steps; // null for none
};

} // namespace osgVolumizer
