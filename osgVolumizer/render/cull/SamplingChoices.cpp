#include "SamplingChoices.h"

#include "../textures/BrickResidency.h"
#include "ChoiceQueue.h"

#include "../../core/accuracy/FilterError.h"
#include "../../core/accuracy/RandomRays.h"
#include "../../core/voxels/ValueReader.h"

#include <glm/common.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// What a frame may spend on sampling; lit rays take seven times as many samples.
constexpr std::chrono::milliseconds PER_FRAME(8), LIT_PER_FRAME(16);
constexpr std::size_t FEWER_LIT = 3; // rays

using Rays = std::vector<core::CellRay>;

// The box around what bricks show under a table.
core::Box3d boxOfShown(const Voxels& voxels, const TableTexture& table)
{
    const osg::ref_ptr<BrickResidency> textures = BrickResidency::of(voxels);
    OccupancyQuery query;
    query.table = &table;
    core::Box3d box;
    for (std::int64_t brick = 0; brick < voxels.getLayout().brickCount(); ++brick) {
        const auto values = voxels.getBrickRange(brick);
        if (!showsValues(voxels, query, values.first, values.second)) continue;
        const auto cells = textures->cells().get(voxels, brick, query);
        if (!cells || cells->box.empty()) continue;
        box.expand(cells->box.min);
        box.expand(cells->box.max);
    }
    return box;
}

// A box outwards to eighths of a larger one, so that small changes of a table leave it as it is.
core::Box3d rounded(const core::Box3d& box, const core::Box3d& whole)
{
    if (box.empty()) return box;
    const glm::dvec3 step = whole.size() / 8.0;
    core::Box3d result;
    for (int axis = 0; axis < 3; ++axis) {
        const double s = step[axis];
        if (!(s > 0.0)) {
            result.min[axis] = box.min[axis];
            result.max[axis] = box.max[axis];
            continue;
        }
        const double origin = whole.min[axis];
        result.min[axis] = origin + s * std::floor((box.min[axis] - origin) / s);
        result.max[axis] = origin + s * std::ceil((box.max[axis] - origin) / s);
    }
    return intersection(result, whole);
}

std::uint64_t modifiedCount(const Voxels& voxels)
{
    std::uint64_t sum = 0;
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i)
        sum += voxels.getModifiedCount(i);
    return sum;
}

// Reads the voxels as fractions of their range; holes are the lowest value, as in textures.
class Reader
{
public:
    Reader(const Voxels& voxels, bool nearest)
        : _voxels(voxels), _blocks(std::size_t(voxels.getLayout().brickCount())),
          _reader(
              voxels.getLayout(), [this](std::int64_t brick) { return load(brick); },
              nearest ? core::ValueReader::NEAREST : core::ValueReader::LINEAR, 0,
              voxels.getRange().x())
    {
        const osg::Vec2d range = voxels.getRange();
        _scale = 1.0 / (range.y() - range.x());
        _offset = -range.x() * _scale;
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    double operator()(const glm::dvec3& positionVoxel)
    {
        return _reader.value(positionVoxel) * _scale + _offset;
    }

private:
    core::ValueReader::Brick load(std::int64_t brick)
    {
        VoxelBlock& block = _blocks[static_cast<std::size_t>(brick)];
        if (!block) block = BrickResidency::load(_voxels, brick);
        return {{block.data, _voxels.getType(), _voxels.getComponents(),
                 _voxels.getLayout().brick(brick).samples.size()},
                block.owner};
    }

    const Voxels& _voxels;
    std::vector<VoxelBlock> _blocks;
    core::ValueReader _reader;
    double _scale, _offset;
};

std::vector<glm::vec4> texelsOf(const TableTexture& table)
{
    const core::ExtinctionTable entries = table.entries();
    if (entries.empty()) return {};
    const int count = entries.integrals ? 2 * entries.count + 1 : entries.count;
    return {entries.texels, entries.texels + count};
}

} // namespace

struct SamplingChoices::Sampled
{
    std::mutex mutex; ///< of what follows; held while a frame samples
    core::RandomRays random;
    std::shared_ptr<Rays> rays = std::make_shared<Rays>(); ///< not changed once others see it
    bool shared = false;
    std::size_t cells = 0;
    const core::Box3d box; ///< voxel frame

    const bool lit;

    Sampled(const core::Box3d& shown, const SamplingQuestion& q)
        : random(shown, q.frameToUnits, q.nearest, q.shading.has_value()), box(shown),
          lit(q.shading.has_value())
    {
    }
};

// Of one question. Owns all it is made from.
struct SamplingChoices::Answer
{
    std::atomic<bool> deciding{false};
    std::mutex mutex; ///< of what follows, but for what never changes
    std::size_t wanted = core::FIRST_RAYS;
    bool known = false;
    core::PeriodChoice choice;
    double filterError = -1.0;
    // Never changed:
    std::vector<glm::vec4> midpoints, integrals;
    std::shared_ptr<const core::IntervalTable> table;
    std::optional<core::RayShading> shading;
    LookupTable::Function function;
    core::PeriodQuestion question;
    std::shared_ptr<Sampled> sampled; ///< null where nothing shows

    Answer(const SamplingQuestion& q, std::shared_ptr<Sampled> rays)
        : midpoints(texelsOf(q.midpoints)), integrals(texelsOf(q.integrals)),
          table(q.intervals.intervals), shading(q.shading), function(q.intervals.function),
          sampled(std::move(rays))
    {
        if (shading) {
            question.shading = &*shading;
            wanted /= FEWER_LIT;
        }
        question.tolerance = q.tolerance;
        question.opaqueEnough = q.opaqueEnough;
        question.cells = q.cells;
        question.table = table.get();
        question.midpoints = q.midpoints.entries();
        question.midpoints.texels = midpoints.data();
        question.integrals = q.integrals.entries();
        question.integrals.texels = integrals.data();
    }
};

namespace {

// A question in the queue, or being decided; over when this is destroyed, whether it was or not.
class Decision
{
public:
    explicit Decision(std::shared_ptr<SamplingChoices::Answer> answer) : _answer(std::move(answer))
    {
        _answer->deciding = true;
    }
    ~Decision() { _answer->deciding = false; }
    Decision(const Decision&) = delete;
    Decision& operator=(const Decision&) = delete;
    SamplingChoices::Answer& answer() const { return *_answer; }

private:
    std::shared_ptr<SamplingChoices::Answer> _answer;
};

// Another thread's part.
void decide(SamplingChoices::Answer& answer, const Rays& rays, std::size_t count, bool mayGrow)
{
    const core::IntervalTable exact = core::makeIntervalTable(*answer.function, 0.0);
    core::PeriodQuestion question = answer.question;
    question.exact = &exact;
    const core::PeriodAnswer found = core::choosePeriod(question, rays, count);
    std::lock_guard<std::mutex> lock(answer.mutex);
    answer.choice = found.choice;
    answer.choice.filterError = answer.filterError;
    answer.known = !found.wantsMore || !mayGrow;
    answer.wanted = 2 * count;
}

// A frame's part: true when there are as many rays as are wanted.
bool sample(SamplingChoices::Sampled& sampled, Reader& reader, std::size_t wanted)
{
    const auto end = std::chrono::steady_clock::now() + (sampled.lit ? LIT_PER_FRAME : PER_FRAME);
    const auto enough = [&]() {
        return sampled.rays->size() >= wanted || sampled.cells >= core::MOST_RAY_CELLS;
    };
    if (enough()) return true;
    if (sampled.shared) sampled.rays = std::make_shared<Rays>(*sampled.rays);
    sampled.shared = false;
    const core::FractionField field = [&reader](const glm::dvec3& p) { return reader(p); };
    while (!enough() && std::chrono::steady_clock::now() < end) {
        sampled.rays->push_back(sampled.random.next(field));
        sampled.cells += sampled.rays->back().cellCount();
    }
    return enough();
}

} // namespace

SamplingChoices::~SamplingChoices()
{
    ChoiceQueue::instance().forget(this);
}

bool SamplingChoices::DataKey::operator==(const DataKey& o) const
{
    return layoutCount == o.layoutCount && modified == o.modified &&
           frameToUnits == o.frameToUnits && box == o.box && nearest == o.nearest && lit == o.lit;
}

bool SamplingChoices::Key::operator==(const Key& o) const
{
    return midpointsId == o.midpointsId && integralsId == o.integralsId &&
           intervalsId == o.intervalsId && tolerance == o.tolerance && cells == o.cells &&
           shading == o.shading && data == o.data;
}

// What shows something is looked for once for each question, not in every frame.
std::shared_ptr<SamplingChoices::Answer> SamplingChoices::answerTo(const Voxels& voxels,
                                                                   const SamplingQuestion& q)
{
    DataKey data{voxels.getLayoutCount(), modifiedCount(voxels), q.frameToUnits, q.box, q.nearest,
                 q.shading.has_value()};
    glm::dvec4 shading(0.0);
    if (q.shading)
        shading = {q.shading->ambient, q.shading->diffuse, q.shading->specular,
                   q.shading->shininess};
    const Key key{
        q.midpoints.id, q.integrals.id, q.intervals.id, q.tolerance, q.cells, shading, data};
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (const auto* known = _answers.find(key)) return *known;
    }
    data.box = rounded(intersection(boxOfShown(voxels, q.intervals), q.box), q.box);
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _answers.find(key)) return *known;
    std::shared_ptr<Sampled> sampled;
    if (!data.box.empty()) {
        const auto* rays = _sampled.find(data);
        sampled = rays ? *rays : _sampled.add(data, std::make_shared<Sampled>(data.box, q));
    }
    return _answers.add(key, std::make_shared<Answer>(q, sampled));
}

std::optional<core::PeriodChoice> SamplingChoices::get(const Voxels& voxels,
                                                       const SamplingQuestion& q)
{
    const std::shared_ptr<Answer> answer = answerTo(voxels, q);
    std::unique_lock<std::mutex> lock(answer->mutex);
    if (answer->known) {
        answer->sampled.reset(); // as large as the rays are
        return answer->choice;
    }
    if (answer->deciding) return std::nullopt;
    if (!answer->sampled) { // nothing shows
        answer->choice = core::choosePeriod(answer->question, {}, 0).choice;
        answer->known = true;
        return answer->choice;
    }
    Sampled& sampled = *answer->sampled;
    std::lock_guard<std::mutex> sampling(sampled.mutex);
    Reader reader(voxels, q.nearest);
    if (answer->filterError < 0.0) {
        answer->filterError =
            core::filterError([&reader](const glm::dvec3& p) { return reader(p); }, sampled.box,
                              q.frameToUnits, *answer->table, core::PeriodChoice::FILTER_WEIGHT);
        return std::nullopt; // enough for a frame, which may have made tables
    }
    if (!sample(sampled, reader, answer->wanted)) return std::nullopt;
    sampled.shared = true;
    const bool mayGrow = 2 * answer->wanted <= core::MOST_RAYS / (sampled.lit ? FEWER_LIT : 1) &&
                         sampled.cells < core::MOST_RAY_CELLS;
    const std::shared_ptr<const Rays> rays = sampled.rays;
    const std::size_t count = answer->wanted; // others may have wanted more
    const auto decision = std::make_shared<Decision>(answer);
    lock.unlock();
    ChoiceQueue::instance().ask(this, [decision, rays, count, mayGrow] {
        decide(decision->answer(), *rays, count, mayGrow);
    });
    return std::nullopt;
}

} // namespace render
} // namespace osgVolumizer
