#include "FusedDrawing.h"

#include "../context/AttributeScope.h"
#include "../context/ProgramInterface.h"
#include "../context/Uniforms.h"
#include "BatchDrawing.h"
#include "FusedSource.h"
#include "PixelRays.h"
#include "VolumeProgram.h"
#include "VolumeUniforms.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <map>

namespace osgVolumizer {
namespace render {

namespace {

constexpr int MOST_OTHER_STEPS = 1 << 16; // of one member
constexpr int MOST_TRIES = 8;             // for a period, of steps that adapt

constexpr unsigned FIRST_MEMBER_UNIT = UNIT_CELLS; // before are those of the march

// Hands out texture units; the same one for the same table.
class Units
{
public:
    explicit Units(int count) : _end(static_cast<unsigned>(std::max(count, 0))) {}
    unsigned take(unsigned count = 1)
    {
        _next += count;
        return _next - count;
    }
    unsigned ofTable(const osg::TextureBuffer* table)
    {
        const auto known = _tables.find(table);
        if (known != _tables.end()) return known->second;
        return _tables[table] = take();
    }
    unsigned taken() const { return _next; }
    bool suffice() const { return _next <= _end; }

private:
    unsigned _next = FIRST_MEMBER_UNIT, _end;
    std::map<const osg::TextureBuffer*, unsigned> _tables;
};

Result<PixelRays> raysOf(const FusedDrawing& drawing, const FusedMember& member)
{
    const FusedVolumes& volumes = *drawing.part.fused;
    const glm::dvec3 center(glm::inverse(member.frameToEye) * glm::dvec4(volumes.centerEye, 1.0));
    return pixelRays(member.frameToEye, drawing.projection, drawing.viewport,
                     volumes.referenceDepth, center);
}

bool isHomogeneous(const FusedMember& member)
{
    const ProgramFeatures& features = member.part->features;
    return member.batch.cells && member.batch.cells->homogeneous && !features.shading &&
           features.paintCount == 0 && !features.fog && !features.vertexColors &&
           features.fieldCount == 0;
}

// Values and table of a member, for a program whose names of them have a suffix or none.
bool setMember(const FusedDrawing& drawing, const FusedMember& member, const Uniforms& uniforms,
               unsigned tableUnit, unsigned paintUnit)
{
    osg::State& state = *drawing.renderInfo.getState();
    const Result<PixelRays> rays = raysOf(drawing, member);
    if (!rays) return false;
    const VolumePart& part = *member.part;
    setUniforms(state, uniforms, part, *rays, member.frameToEye,
                drawing.resources.part<AccumulationBuffers>());
    if (part.look->table.texture && !applyTable(state, part.look->table.texture.get(), tableUnit))
        return false;
    if (part.paints)
        setPaints(drawing.renderInfo, drawing.resources.limits, uniforms, *part.paints, paintUnit);
    return true;
}

BatchDrawing batchDrawing(const FusedDrawing& drawing, const FusedMember& member,
                          const Uniforms& uniforms, const core::View& view)
{
    return {drawing.renderInfo, drawing.resources.limits, uniforms, member.part->features, view};
}

bool setMarched(const FusedDrawing& drawing, const FusedMember& member, const Uniforms& uniforms,
                Units& units)
{
    const ProgramFeatures& features = member.part->features;
    const core::View view{member.frameToEye, drawing.projection};
    const unsigned table = units.ofTable(member.part->look->table.texture.get());
    BatchDrawing batch = batchDrawing(drawing, member, uniforms, view);
    batch.voxelUnit = units.take();
    batch.cellUnit = features.skipping ? units.take() : 0;
    batch.nextVoxelUnit = features.blendsSteps ? units.take() : 0;
    const unsigned cut = features.cutField ? units.take() : 0;
    const unsigned paints = units.take(2 * static_cast<unsigned>(features.paintCount));
    if (!units.suffice() || !setMember(drawing, member, uniforms, table, paints)) return false;
    uniforms.set("voxels", static_cast<int>(batch.voxelUnit));
    if (features.blendsSteps) uniforms.set("nextVoxels", static_cast<int>(batch.nextVoxelUnit));
    uniforms.set("lookupTable", static_cast<int>(table));
    if (features.skipping) uniforms.set("cells", static_cast<int>(batch.cellUnit));
    if (features.cutField) {
        if (!applyCutField(*drawing.renderInfo.getState(), member.part->look->cut, cut))
            return false;
        uniforms.set("cutField", static_cast<int>(cut));
    }
    if (features.tetrahedra) {
        const VolumeLook& look = *member.part->look;
        const unsigned first = units.take(static_cast<unsigned>(look.tetrahedra->all().size()));
        if (!units.suffice() ||
            !setTetrahedra(*drawing.renderInfo.getState(), uniforms, look, first))
            return false;
    }
    if (!drawing.part.features.inOrder && isHomogeneous(member)) {
        uniforms.set("stepsPerDepth", 0.0f);
        uniforms.set("stepsPerLength", 0.0f);
    }
    return setBatch(batch, member.batch);
}

} // namespace

bool setMembers(const FusedDrawing& drawing, const osg::Program::PerContextProgram& program)
{
    osg::GLExtensions& gl = *drawing.renderInfo.getState()->get<osg::GLExtensions>();
    const std::vector<FusedMember>& members = drawing.part.fused->members;
    Units units(drawing.resources.limits.textureUnits);
    int mostSteps = 0;
    bool adapt = false;
    double opaqueEnough = 1.0, mostWeight = 1.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Uniforms uniforms(gl, program, memberSuffix(i));
        if (!setMarched(drawing, members[i], uniforms, units)) return false;
        const VolumeLook& look = *members[i].part->look;
        opaqueEnough = std::min(opaqueEnough, look.opaqueEnough);
        // What it is cut into, and its paints cut besides.
        mostSteps += look.maximumSteps + 2 * (members[i].part->features.paintCount + 1);
        if (look.features.adaptive) {
            mostWeight = std::min(mostWeight, look.mostWeight);
            adapt = true;
        }
        // Steps end with tetrahedra, and pieces, too.
        if (members[i].part->features.tetrahedra || members[i].part->features.cells)
            mostSteps += MOST_OTHER_STEPS;
    }
    for (unsigned unit = FIRST_MEMBER_UNIT; unit < units.taken(); ++unit)
        drawing.renderInfo.getState()->haveAppliedTextureAttribute(unit,
                                                                   osg::StateAttribute::TEXTURE);
    const Uniforms uniforms(gl, program);
    uniforms.set("mostSteps", static_cast<float>(adapt ? MOST_TRIES * mostSteps : mostSteps));
    uniforms.set("opaqueEnough", static_cast<float>(opaqueEnough));
    uniforms.set("mostWeight", static_cast<float>(mostWeight));
    return true;
}

void drawMembersApart(const FusedDrawing& drawing, const BrickBatch& triangles)
{
    osg::State& state = *drawing.renderInfo.getState();
    const AttributeScope programScope(state, osg::StateAttribute::PROGRAM);
    const AttributeScope blendScope(state, osg::StateAttribute::BLENDFUNC);
    for (const FusedMember& member : drawing.part.fused->members) {
        const auto set = volumeStateSet(member.part->features);
        state.applyAttribute(set->getAttribute(osg::StateAttribute::PROGRAM));
        state.applyAttribute(set->getAttribute(osg::StateAttribute::BLENDFUNC));
        const auto* program = state.getLastAppliedProgramObject();
        if (!program) continue;
        const Uniforms uniforms(*state.get<osg::GLExtensions>(), *program);
        const glm::dmat4 inDevice(1.0);
        uniforms.set("frameToClip", inDevice);
        setSamplers(uniforms);
        if (!setMember(drawing, member, uniforms, UNIT_TABLE, UNIT_FIRST_PAINT)) continue;
        if (member.part->features.cutField) {
            const unsigned unit = cutUnitOf(member.part->features);
            if (!applyCutField(state, member.part->look->cut, unit)) continue;
            uniforms.set("cutField", static_cast<int>(unit));
        }
        if (member.part->features.tetrahedra &&
            !setTetrahedra(state, uniforms, *member.part->look, tetraUnitOf(member.part->features)))
            continue;
        const core::View view{member.frameToEye, drawing.projection};
        BrickBatch batch = member.batch;
        batch.firstIndex = triangles.firstIndex;
        batch.indexCount = triangles.indexCount;
        drawBatch(batchDrawing(drawing, member, uniforms, view), batch);
    }
}

} // namespace render
} // namespace osgVolumizer
