#include "FuseVolumes.h"

#include "../context/LeafState.h"
#include "../context/Matrices.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../draw/BatchDrawing.h"
#include "../draw/FusedVolumes.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <set>

namespace osgVolumizer {
namespace render {

namespace {

// Which of the scene's lights a volume is lit by, as bits.
unsigned lightsOn(const VolumeInstance& volume)
{
    unsigned bits = 0;
    if (!volume.look->features.shading) return bits;
    for (unsigned light = 0; light < MAXIMUM_LIGHTS; ++light)
        bits |= unsigned(isOn(volume.leaf->_parent, GL_LIGHT0 + light, false)) << light;
    return bits;
}

bool canBeFused(const MergedVolume& volume)
{
    const ProgramFeatures& features = volume.instance->look->features;
    const bool joins = features.tetrahedra ? features.integratesLight() : features.voxels;
    return !volume.sliced && joins && !features.gathers() && volume.instance->above.isUsual() &&
           !volume.instance->bricks.empty();
}

// Whether two have the same state above them, as far as it matters to what is drawn at once.
bool alike(const VolumeInstance& a, const VolumeInstance& b)
{
    const bool bothLit = a.look->features.shading && b.look->features.shading;
    const auto viewportOf = [](const VolumeInstance& volume) {
        return effectiveAttribute(volume.leaf->_parent, osg::StateAttribute::VIEWPORT);
    };
    return viewportOf(a) == viewportOf(b) && *a.leaf->_projection == *b.leaf->_projection &&
           (!bothLit || lightsOn(a) == lightsOn(b)) && a.countSamples == b.countSamples;
}

// Texture units that some volumes take.
int unitsOf(const std::vector<const VolumeInstance*>& volumes)
{
    std::set<const osg::TextureBuffer*> tables;
    std::size_t units = UNIT_CELLS;
    for (const VolumeInstance* volume : volumes) {
        tables.insert(volume->look->table.texture.get());
        const std::size_t paints = volume->paints ? 2 * volume->paints->size() : 0;
        const std::size_t steps = static_cast<std::size_t>(volume->steps.count());
        const std::size_t cut = volume->look->features.cutField ? 1 : 0;
        if (volume->look->tetrahedra)
            units += volume->bricks.size() * volume->look->tetrahedra->all().size();
        units += volume->bricks.size() * ((volume->skipping ? 1u : 0u) + steps + paints + cut);
    }
    return static_cast<int>(units + tables.size());
}

// Bricks count as volumes.
std::size_t bricksOf(const std::vector<const VolumeInstance*>& volumes)
{
    std::size_t count = 0;
    for (const VolumeInstance* volume : volumes)
        count += volume->bricks.size();
    return count;
}

core::DepthInterval united(const core::DepthInterval& a, const core::DepthInterval& b)
{
    return {std::min(a.nearDepth, b.nearDepth), std::max(a.farDepth, b.farDepth)};
}

void addMembers(const MergedVolume& volume, FusedVolumes& fused)
{
    const VolumeInstance& instance = *volume.instance;
    const auto part = std::make_shared<const VolumePart>(partOf(instance));
    for (const SelectedBrick& brick : instance.bricks)
        fused.members.push_back({part, batchOf(brick), toGlm(*instance.frameToEye)});
}

// The march's own look, in the frame of the volume whose leaf stands for all.
std::shared_ptr<const VolumeLook> lookOf(const FusedVolumes& fused, const MergedVolume& first,
                                         bool inOrder)
{
    auto look = std::make_shared<VolumeLook>();
    look->features.voxels = false;
    look->features.opaqueDepth = true;
    look->features.countSamples = first.instance->countSamples;
    look->features.inOrder = inOrder;
    look->referenceDepth = fused.referenceDepth;
    look->center = glm::dvec3(glm::inverse(first.view.toEye) * glm::dvec4(fused.centerEye, 1.0));
    look->step = first.step;
    return look;
}

// Expects one at least, in an order that does not depend on that of the nodes.
MergedVolume fusedOf(std::vector<MergedVolume>& volumes)
{
    auto fused = std::make_shared<FusedVolumes>();
    MergedVolume result = std::move(volumes.front());
    addMembers(result, *fused);
    for (std::size_t i = 1; i < volumes.size(); ++i) {
        addMembers(volumes[i], *fused);
        result.depth = united(result.depth, volumes[i].depth);
        result.wholeDepth = united(result.wholeDepth, volumes[i].wholeDepth);
        result.step = std::min(result.step, volumes[i].step);
        result.screen = {glm::min(result.screen.min, volumes[i].screen.min),
                         glm::max(result.screen.max, volumes[i].screen.max)};
        result.rayDistance = std::max(result.rayDistance, volumes[i].rayDistance);
    }
    const auto centerOf = [](const FusedMember& member) {
        return glm::dvec3(member.frameToEye * glm::dvec4(member.part->look->center, 1.0));
    };
    glm::dvec3 low = centerOf(fused->members.front()), high = low;
    for (const FusedMember& member : fused->members) {
        low = glm::min(low, centerOf(member));
        high = glm::max(high, centerOf(member));
    }
    fused->centerEye = 0.5 * (low + high);
    fused->referenceDepth = -fused->centerEye.z;
    result.look = lookOf(*fused, result, volumes.size() == 1);
    result.fused = std::move(fused);
    return result;
}

std::vector<const VolumeInstance*> instancesOf(const std::vector<MergedVolume>& volumes)
{
    std::vector<const VolumeInstance*> instances;
    for (const MergedVolume& volume : volumes)
        instances.push_back(volume.instance);
    return instances;
}

bool fits(std::vector<const VolumeInstance*> volumes, const VolumeInstance& another,
          const FuseLimits& limits)
{
    volumes.push_back(&another);
    return bricksOf(volumes) <= std::size_t(limits.volumes) &&
           unitsOf(volumes) <= limits.textureUnits;
}

} // namespace

void fuseVolumes(std::vector<MergedVolume>& volumes, const FuseLimits& limits, bool splitBricks)
{
    std::vector<std::vector<MergedVolume>> marches;
    std::vector<MergedVolume> rest;
    bool tooMany = false;
    for (MergedVolume& volume : volumes) {
        const auto march = std::find_if(marches.begin(), marches.end(), [&](const auto& m) {
            const bool like = std::all_of(m.begin(), m.end(), [&](const MergedVolume& other) {
                return alike(*other.instance, *volume.instance);
            });
            const bool room = fits(instancesOf(m), *volume.instance, limits);
            tooMany = tooMany || (like && !room);
            return like && room;
        });
        if (!canBeFused(volume) || !fits({}, *volume.instance, limits)) {
            rest.push_back(std::move(volume));
        } else if (march != marches.end()) {
            march->push_back(std::move(volume));
        } else {
            marches.emplace_back();
            marches.back().push_back(std::move(volume));
        }
    }
    if (tooMany)
        reportOnce(
            {ErrorCode::NOT_SUPPORTED,
             "more volumes overlap than can be marched together; they are marched in groups, "
             "merged in thin slabs, which takes longer"});
    volumes.clear();
    for (std::vector<MergedVolume>& march : marches) {
        const bool one = march.size() == 1 && march.front().instance->bricks.size() == 1;
        const bool alone = march.size() == 1 && !splitBricks;
        volumes.push_back(one || alone ? std::move(march.front()) : fusedOf(march));
    }
    for (MergedVolume& volume : rest)
        volumes.push_back(std::move(volume));
}

} // namespace render
} // namespace osgVolumizer
