#include "SamplingChoices.h"

#include "../textures/BrickResidency.h"

#include "../../core/voxels/ValueReader.h"

#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// The samples of the bricks that show something under a table, and the box around what they show.
class ShownBricks
{
public:
    ShownBricks(const Voxels& voxels, const TableTexture& table)
        : _voxels(voxels), _blocks(std::size_t(voxels.getLayout().brickCount()))
    {
        const osg::ref_ptr<BrickResidency> textures = BrickResidency::of(voxels);
        OccupancyQuery query;
        query.table = &table;
        for (std::size_t i = 0; i < _blocks.size(); ++i) {
            const auto brick = static_cast<std::int64_t>(i);
            const auto values = voxels.getBrickRange(brick);
            if (!showsValues(voxels, query, values.first, values.second)) continue;
            _blocks[i] = BrickResidency::load(voxels, brick);
            if (!_blocks[i]) continue;
            const auto cells = textures->cells().get(voxels, brick, query);
            if (!cells || cells->box.empty()) continue;
            _box.expand(cells->box.min);
            _box.expand(cells->box.max);
        }
    }

    const core::Box3d& box() const { return _box; } ///< voxel frame
    core::ValueReader::Brick operator()(std::int64_t brick) const
    {
        const VoxelBlock& block = _blocks[static_cast<std::size_t>(brick)];
        return {{block.data, _voxels.getType(), _voxels.getComponents(),
                 _voxels.getLayout().brick(brick).samples.size()},
                block.owner};
    }

private:
    const Voxels& _voxels;
    std::vector<VoxelBlock> _blocks; ///< empty where nothing shows
    core::Box3d _box;
};

core::PeriodChoice choose(const Voxels& voxels, const SamplingQuestion& q)
{
    const ShownBricks shown(voxels, q.integrals.texture ? q.integrals : q.midpoints);
    const osg::Vec2d range = voxels.getRange();
    // Holes show what the lowest value shows, as in textures.
    core::ValueReader reader(
        voxels.getLayout(), [&shown](std::int64_t brick) { return shown(brick); },
        q.nearest ? core::ValueReader::NEAREST : core::ValueReader::LINEAR, 0, range.x());
    const double scale = 1.0 / (range.y() - range.x()), offset = -range.x() * scale;
    core::PeriodQuestion question;
    question.tolerance = q.tolerance;
    question.midpoints = q.midpoints.entries();
    question.integrals = q.integrals.entries();
    question.voxelToUnits = q.frameToUnits;
    question.box = intersection(shown.box(), q.box);
    return core::choosePeriod(
        [&](const glm::dvec3& positionVoxel) {
            return reader.value(positionVoxel) * scale + offset;
        },
        question);
}

std::uint64_t modifiedCount(const Voxels& voxels)
{
    std::uint64_t sum = 0;
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i)
        sum += voxels.getModifiedCount(i);
    return sum;
}

} // namespace

bool SamplingChoices::Key::operator==(const Key& o) const
{
    return midpointsId == o.midpointsId && integralsId == o.integralsId &&
           layoutCount == o.layoutCount && modified == o.modified && tolerance == o.tolerance &&
           frameToUnits == o.frameToUnits && box == o.box && nearest == o.nearest;
}

std::shared_ptr<SamplingChoices::Answer> SamplingChoices::answerTo(const Key& key)
{
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _answers.find(key)) return *known;
    return _answers.add(key, std::make_shared<Answer>());
}

core::PeriodChoice SamplingChoices::get(const Voxels& voxels, const SamplingQuestion& q)
{
    const std::shared_ptr<Answer> answer =
        answerTo({q.midpoints.id, q.integrals.id, voxels.getLayoutCount(), modifiedCount(voxels),
                  q.tolerance, q.frameToUnits, q.box, q.nearest});
    std::lock_guard<std::mutex> lock(answer->mutex);
    if (!answer->known) answer->choice = choose(voxels, q);
    answer->known = true;
    return answer->choice;
}

} // namespace render
} // namespace osgVolumizer
