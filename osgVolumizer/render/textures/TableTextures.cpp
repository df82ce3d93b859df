#include "TableTextures.h"

#include "../context/Allocation.h"
#include "../context/RenderDataAccess.h"
#include "../context/ReportOnce.h"

#include "../../core/transfer/PreIntegration.h"

#include <osg/Notify>

#include <glm/vec3.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <list>
#include <utility>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double BITS = 1.0 / 0.6931471805599453; // of extinction, in units of -ln(transmittance)

// As few as stay in a cache; so many that the nearest one hardly differs.
constexpr int FEWEST_ENTRIES = 1024, ENTRIES = 16384;
// What emission and extinction may differ by from entry to entry, bits per opacity unit: rays of a
// hundred samples are then off by some 1e-6.
constexpr double ENTRY_STEP = 4e-6;

// Bits times entries: differences of floats that are not larger are good to 1e-4 bits.
constexpr float LARGEST_INTEGRAL = 8192.0f;

// A 64th of the range is what the value commonly changes by from sample to sample.
constexpr double WINDOW = 1.0 / 64.0;

// Whether midpoint sampling at a usual rate would be off by so much that pre-integration pays; says
// why.
bool needsPreIntegration(const core::WindowError& error, const std::string& name)
{
    constexpr double TOLERANCE = 0.03;
    if (error.error <= TOLERANCE) return false;
    OSG_INFO << "osgVolumizer: lookup table \"" << name << "\" is pre-integrated: at "
             << error.value << " of the range, samples a " << 1.0 / WINDOW
             << "th of it apart miss the mean of what lies between by " << error.error << "."
             << std::endl;
    return true;
}

// How many entries a function needs where the nearest one is taken.
int entriesFor(const core::TransferFunction& function)
{
    const std::vector<glm::vec4> texels =
        function.tabulateExtinction(FEWEST_ENTRIES, 0.0, 1.0, false);
    double steepest = 0.0; // bits from one of these entries to the next
    for (std::size_t i = 1; i < texels.size(); ++i) {
        const glm::dvec4 a(texels[i - 1]), b(texels[i]);
        const glm::dvec3 emission = glm::abs(glm::dvec3(b) * b.a - glm::dvec3(a) * a.a);
        steepest = std::max({steepest, std::abs(b.a - a.a), emission.x, emission.y, emission.z});
    }
    const double needed = steepest * BITS * FEWEST_ENTRIES / ENTRY_STEP;
    int entries = FEWEST_ENTRIES;
    while (entries < needed && entries < ENTRIES)
        entries *= 2;
    return entries;
}

osg::ref_ptr<osg::TextureBuffer> makeTexture(const std::vector<glm::vec4>& texels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texels.size()), 1, 1, GL_RGBA, GL_FLOAT, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(glm::vec4));
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer;
    texture->setImage(image);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setUnRefImageDataAfterApply(false);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

// Prefix sums over the entries that show something, and over those about which integrals grow.
void countShown(const std::vector<glm::vec4>& texels, TableTexture& table)
{
    const auto count = static_cast<std::size_t>(table.count);
    auto entries = std::make_shared<std::vector<int>>(1, 0);
    auto gaps = std::make_shared<std::vector<int>>(1, 0);
    for (std::size_t i = 0; i < count; ++i)
        entries->push_back(entries->back() + (texels[i].a > 0.0f));
    for (std::size_t i = 0; table.integrals && i < count; ++i)
        gaps->push_back(gaps->back() + (texels[count + i + 1].a > texels[count + i].a));
    table.shownEntries = std::move(entries);
    table.shownGaps = std::move(gaps);
}

// Kinks that are not sharper are left to Gauss's rule: see core::makeIntervalTable().
constexpr double SHARP = 0.03;

std::shared_ptr<TableTexture> makeIntervals(const LookupTable& table, const osg::Vec2d& range)
{
    auto made = std::make_shared<TableTexture>();
    made->function = table.getNormalizedFunction(range);
    auto intervals =
        std::make_shared<core::IntervalTable>(core::makeIntervalTable(*made->function, SHARP));
    made->count = 2;
    auto shown = std::make_shared<std::vector<int>>(1, 0);
    for (const glm::vec4& texel : intervals->texels)
        shown->push_back(shown->back() + (texel.a > 0.0f));
    made->shownEntries = std::move(shown);
    made->texture = makeTexture(intervals->texels);
    made->intervals = std::move(intervals);
    return made;
}

std::shared_ptr<const TableTexture> makeTable(const LookupTable& table, const osg::Vec2d& range,
                                              VolumeAppearance::Lookup lookup)
{
    static std::atomic<unsigned> nextId{1};
    if (lookup == VolumeAppearance::CELL_BY_CELL) {
        auto made = makeIntervals(table, range);
        made->id = nextId++;
        return made;
    }
    auto made = std::make_shared<TableTexture>();
    TableTexture& result = *made;
    result.function = table.getNormalizedFunction(range);
    result.id = nextId++;
    const core::WindowError missed = core::windowError(*result.function, 0.0, 1.0, WINDOW);
    result.missed = missed.error;
    result.integrals = lookup == VolumeAppearance::PREINTEGRATED ||
                       (lookup == VolumeAppearance::AUTOMATIC_LOOKUP &&
                        needsPreIntegration(missed, table.getName()));
    result.count = result.integrals ? ENTRIES : entriesFor(*result.function);
    std::vector<glm::vec4> texels =
        result.function->tabulateExtinction(result.count, 0.0, 1.0, false);
    for (glm::vec4& t : texels)
        t.a *= static_cast<float>(BITS);
    const auto emission = [](const glm::vec4& t) { return glm::vec4(glm::vec3(t) * t.a, t.a); };
    result.low = emission(texels.front());
    result.high = emission(texels.back());
    if (result.integrals) {
        const core::TransferIntegral integral(*result.function);
        const double half = 0.5 / (ENTRIES - 1.0);
        for (const glm::dvec4& sum : integral.tabulate(ENTRIES + 1, -half, 1.0 + half))
            texels.emplace_back(sum * BITS);
        result.shortRuns = texels.back().a > LARGEST_INTEGRAL;
    } else {
        texels.push_back(texels.back()); // for interpolation at the last
    }
    countShown(texels, result);
    result.texture = makeTexture(texels);
    return made;
}

constexpr double FAR_AWAY = 1e30; // beyond what scalars are held to

// The points that a function needs, between two far away that are like the first and the last.
std::vector<core::TransferFunction::Point> cornersOf(const core::TransferFunction& function)
{
    constexpr double TOLERANCE = 1e-9;
    using Point = core::TransferFunction::Point;
    const std::vector<Point>& all = function.points();
    std::vector<Point> corners{{-FAR_AWAY, all.front().color}};
    for (std::size_t i = 0; i < all.size(); ++i) {
        corners.push_back(all[i]);
        if (i == 0 || i + 1 == all.size()) continue;
        const Point &before = corners[corners.size() - 2], &after = all[i + 1];
        const double width = after.value - before.value;
        if (!(width > 0.0) || before.value == all[i].value || all[i].value == after.value) continue;
        const double f = (all[i].value - before.value) / width;
        const glm::dvec4 off = glm::abs(glm::mix(before.color, after.color, f) - all[i].color);
        if (std::max({off.x, off.y, off.z, off.w}) < TOLERANCE) corners.pop_back();
    }
    corners.push_back({FAR_AWAY, all.back().color});
    return corners;
}

std::shared_ptr<const TableTexture> makePoints(const LookupTable& table, const osg::Vec2d& range)
{
    auto made = std::make_shared<TableTexture>();
    made->function = table.getNormalizedFunction(range);
    const auto corners = cornersOf(*made->function);
    made->count = static_cast<int>(corners.size());
    std::vector<glm::vec4> texels;
    for (const auto& corner : corners) {
        texels.emplace_back(corner.color);
        texels.emplace_back(static_cast<float>(std::clamp(corner.value, -FAR_AWAY, FAR_AWAY)), 0.0f,
                            0.0f, 0.0f);
    }
    made->texture = makeTexture(texels);
    return made;
}

// What a lookup table's textures are made from.
struct TableKey
{
    unsigned modifiedCount;
    osg::Vec2d range;
    VolumeAppearance::Lookup lookup;
    bool operator==(const TableKey& o) const
    {
        return modifiedCount == o.modifiedCount && range == o.range && lookup == o.lookup;
    }
};

// The textures of one lookup table that an appearance still has.
class SharedTables : public RenderData
{
public:
    static osg::ref_ptr<SharedTables> of(const LookupTable& table)
    {
        return renderData<SharedTables>(table);
    }
    std::shared_ptr<const TableTexture> get(const LookupTable& table, const TableKey& key)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        std::shared_ptr<const TableTexture> result;
        _tables.remove_if([](const auto& known) { return known.second.expired(); });
        for (const auto& known : _tables)
            if (known.first == key) result = known.second.lock();
        if (result) return result;
        result = makeTable(table, key.range, key.lookup);
        _tables.emplace_front(key, result);
        return result;
    }
    // Appearances do that.
    void resizeGLObjectBuffers(unsigned int) override {}
    void releaseGLObjects(osg::State*) const override {}

private:
    std::mutex _mutex;
    std::list<std::pair<TableKey, std::weak_ptr<const TableTexture>>> _tables;
};

} // namespace

bool TableTexture::shows(double lowFraction, double highFraction) const
{
    if (intervals) {
        if (!(lowFraction <= highFraction)) return false;
        constexpr double ROUNDING = 1e-6; // of the shader's floats
        const int last = intervals->find(highFraction + ROUNDING);
        for (int i = intervals->find(lowFraction - ROUNDING); i <= last; ++i) {
            const glm::dvec4 in(intervals->of(i));
            const auto entry = [&in](double value) {
                return in.z + (std::clamp(value, in.x, in.y) - in.x) * in.w;
            };
            const auto first = static_cast<std::size_t>(entry(lowFraction));
            const auto end = static_cast<std::size_t>(std::ceil(entry(highFraction))) + 1;
            if ((*shownEntries)[end] > (*shownEntries)[first]) return true;
        }
        return false;
    }
    // The shader's floats are off by less than a hundredth of an entry.
    const double last = count - 1.0;
    if (!(lowFraction <= highFraction)) return false;
    const auto entry = [last](double v) {
        return static_cast<std::size_t>(std::clamp(v, 0.0, last));
    };
    const std::size_t first = entry(std::floor(lowFraction * last + 0.01));
    const std::size_t end = std::max(entry(std::ceil(highFraction * last - 0.01)), first) + 1;
    return (*shownEntries)[end] > (*shownEntries)[first] ||
           (integrals && (*shownGaps)[end] > (*shownGaps)[first]);
}

core::ExtinctionTable TableTexture::entries() const
{
    if (!texture || intervals) return {};
    return {reinterpret_cast<const glm::vec4*>(texture->getImage()->data()), count, integrals};
}

bool applyTable(osg::State& state, osg::TextureBuffer* texture, unsigned unit)
{
    if (applyAllocated(state, AllocationRequest::TABLE, *texture, unit)) return true;
    reportOnce({ErrorCode::TOO_LARGE, "a lookup table is refused by the graphics card; volumes "
                                      "with it are not drawn"});
    return false;
}

TableTexture TableTextures::get(const LookupTable& table, const osg::Vec2d& range,
                                VolumeAppearance::Lookup lookup)
{
    if (lookup == VolumeAppearance::BEFORE_INTERPOLATION)
        lookup = VolumeAppearance::AFTER_INTERPOLATION;
    const unsigned modified = table.getModifiedCount();
    const Key key{&table, modified, range, lookup, false};
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _tables.find(key)) return **known;
    return *_tables.add(key, SharedTables::of(table)->get(table, {modified, range, lookup}));
}

TableTexture TableTextures::points(const LookupTable& table, const osg::Vec2d& range)
{
    const Key key{&table, table.getModifiedCount(), range, VolumeAppearance::AFTER_INTERPOLATION,
                  true};
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _tables.find(key)) return **known;
    return *_tables.add(key, makePoints(table, range));
}

void TableTextures::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _tables)
        entry.value->texture->resizeGLObjectBuffers(maximum);
}

void TableTextures::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _tables)
        entry.value->texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
