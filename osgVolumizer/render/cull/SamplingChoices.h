#pragma once

#include "../textures/TableTextures.h"

#include "../../Voxels.h"
#include "../../core/RecencyCache.h"
#include "../../core/accuracy/PeriodChoice.h"
#include "../../core/geometry/Box.h"

#include <glm/mat3x3.hpp>

#include <cstdint>
#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// What a choice depends on, besides the data.
struct SamplingQuestion
{
    double tolerance = 1e-3; ///< root mean square error
    TableTexture midpoints;  ///< a table without integrals; none where texture is null
    TableTexture integrals;  ///< the same table with them; none where texture is null
    glm::dmat3 frameToUnits{1.0};
    core::Box3d box; ///< voxel frame; of the region
    bool nearest = false;
};

/// Keeps the answers of core::choosePeriod() to the last few questions. Reads the bricks that show
/// something. Thread safe; whoever asks what is just being chosen waits for it, other questions do
/// not.
class SamplingChoices
{
public:
    /// Expects voxels of one component.
    core::PeriodChoice get(const Voxels& voxels, const SamplingQuestion& question);

private:
    struct Key
    {
        unsigned midpointsId, integralsId, layoutCount;
        std::uint64_t modified;
        double tolerance;
        glm::dmat3 frameToUnits;
        core::Box3d box;
        bool nearest;
        bool operator==(const Key& o) const;
    };
    struct Answer
    {
        std::mutex mutex; ///< of what follows; held while it is chosen
        bool known = false;
        core::PeriodChoice choice;
    };
    static constexpr std::size_t CAPACITY = 4;

    std::shared_ptr<Answer> answerTo(const Key& key);

    std::mutex _mutex;
    core::RecencyCache<Key, std::shared_ptr<Answer>> _answers{CAPACITY};
};

} // namespace render
} // namespace osgVolumizer
