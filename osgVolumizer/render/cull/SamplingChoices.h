#pragma once

#include "../textures/TableTextures.h"

#include "../../Voxels.h"
#include "../../core/RecencyCache.h"
#include "../../core/accuracy/PeriodChoice.h"
#include "../../core/geometry/Box.h"

#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

namespace osgVolumizer {
namespace render {

/// What a choice depends on, besides the data.
struct SamplingQuestion
{
    double tolerance = 1e-3;    ///< root mean square error
    double opaqueEnough = 2e-5; ///< what is left of the light where rays end
    TableTexture midpoints;     ///< a table without integrals; none where texture is null
    TableTexture integrals;     ///< the same table with them; none where texture is null
    TableTexture intervals;     ///< the same table, cut at its corners; always
    bool cells = true;          ///< whether rays may be split at its corners
    glm::dmat3 frameToUnits{1.0};
    core::Box3d box; ///< voxel frame; of the region
    bool nearest = false;
    std::optional<core::RayShading> shading; ///< none: not lit
};

/// Keeps the answers of core::choosePeriod() to the last few questions. Frames do not wait for
/// them: each samples the data for a few milliseconds, and what follows is left to another thread,
/// which never sees the data. Thread safe.
class SamplingChoices
{
public:
    SamplingChoices() = default;
    ~SamplingChoices();
    SamplingChoices(const SamplingChoices&) = delete;
    SamplingChoices& operator=(const SamplingChoices&) = delete;

    /// Null until it is known: ask again. Expects voxels of one component.
    std::optional<core::PeriodChoice> get(const Voxels& voxels, const SamplingQuestion& question);

    struct Sampled; // what is sampled of the data
    struct Answer;

private:
    struct DataKey
    {
        unsigned layoutCount;
        std::uint64_t modified;
        glm::dmat3 frameToUnits;
        core::Box3d box;
        bool nearest, lit;
        bool operator==(const DataKey& o) const;
    };
    struct Key
    {
        unsigned midpointsId, integralsId, intervalsId;
        double tolerance;
        bool cells;
        glm::dvec4 shading; ///< ambient, diffuse, specular, shininess; nothing where it is not lit
        DataKey data;       ///< with the box of the region
        bool operator==(const Key& o) const;
    };

    std::shared_ptr<Answer> answerTo(const Voxels& voxels, const SamplingQuestion& question);

    std::mutex _mutex;
    core::RecencyCache<Key, std::shared_ptr<Answer>> _answers{4};
    /// By the box of what shows something, or a little more.
    core::RecencyCache<DataKey, std::shared_ptr<Sampled>> _sampled{2};
};

} // namespace render
} // namespace osgVolumizer
