#include "ProgramFeatures.h"

#include "RayFunctions.h"

#include <iterator>

namespace osgVolumizer {
namespace render {

namespace {

struct Flag
{
    bool ProgramFlags::*member;
    const char* define;
};

constexpr Flag FLAGS[] = {
    {&ProgramFlags::slab, "SLAB"},
    {&ProgramFlags::voxelCoordinates, "VOXEL_COORDINATES"},
    {&ProgramFlags::vertexColors, "VERTEX_COLORS"},
    {&ProgramFlags::voxels, "VOXELS"},
    {&ProgramFlags::rgba, "RGBA"},
    {&ProgramFlags::opaqueDepth, "OPAQUE_DEPTH"},
    {&ProgramFlags::splitDepth, "SPLIT_DEPTH"},
    {&ProgramFlags::ranked, "RANKED"},
    {&ProgramFlags::spherical, "SPHERICAL"},
    {&ProgramFlags::exact, "EXACT"},
    {&ProgramFlags::nearest, "NEAREST"},
    {&ProgramFlags::cubic, "CUBIC"},
    {&ProgramFlags::before, "BEFORE"},
    {&ProgramFlags::preIntegrated, "PREINTEGRATED"},
    {&ProgramFlags::shortRuns, "SHORT_RUNS"},
    {&ProgramFlags::adaptive, "ADAPTIVE"},
    {&ProgramFlags::cells, "CELLS"},
    {&ProgramFlags::corners, "CORNERS"},
    {&ProgramFlags::smoothTable, "SMOOTH_TABLE"},
    {&ProgramFlags::shading, "SHADING"},
    {&ProgramFlags::gradientTexture, "GRADIENT_TEXTURE"},
    {&ProgramFlags::skipping, "SKIPPING"},
    {&ProgramFlags::countSamples, "COUNT_SAMPLES"},
    {&ProgramFlags::coarse, "COARSE"},
    {&ProgramFlags::blendsSteps, "BLENDS_STEPS"},
    {&ProgramFlags::fog, "FOG"},
    {&ProgramFlags::cut, "CUT"},
    {&ProgramFlags::cutField, "CUT_FIELD"},
    {&ProgramFlags::inOrder, "IN_ORDER"},
    {&ProgramFlags::tetrahedra, "TETRAHEDRA"},
    {&ProgramFlags::scalars, "SCALARS"},
    {&ProgramFlags::cellScalars, "CELL_SCALARS"},
    {&ProgramFlags::places, "PLACES"},
    {&ProgramFlags::wholeRuns, "WHOLE_RUNS"},
};
// A flag without a row would be missing in the key, and programs would be taken for one another.
static_assert(sizeof(ProgramFlags) == sizeof(bool) * std::size(FLAGS), "a row for each flag");

} // namespace

bool ProgramFeatures::gathers() const
{
    return rowOf(rayFunction).gathers;
}

bool ProgramFeatures::integratesLight() const
{
    return rowOf(rayFunction).integratesLight;
}

std::uint64_t ProgramFeatures::key() const
{
    std::uint64_t result = static_cast<std::uint64_t>(planeCount);
    result = result << 3 | static_cast<std::uint64_t>(slotCount / 4);
    result = result << 3 | static_cast<std::uint64_t>(paintCount);
    result = result << 4 | static_cast<std::uint64_t>(filterBits);
    result = result << 8 | static_cast<std::uint64_t>(rayFunction);
    for (const Flag& flag : FLAGS)
        result = result << 1 | std::uint64_t(this->*flag.member);
    return result;
}

std::string ProgramFeatures::defines() const
{
    std::string text;
    const auto define = [&text](bool on, const std::string& name) {
        if (on) text += "#define " + name + "\n";
    };
    for (const Flag& flag : FLAGS)
        define(this->*flag.member, flag.define);
    define(exact || nearest || cubic || before, "FETCH");
    define(isExact(), "EXACT_CELLS");
    define(fieldCount > 0, "FIELDS " + std::to_string(fieldCount));
    define(paintCount > 0, "PAINTED");
    define(slotCount > 0, "SLOTS " + std::to_string(slotCount));
    define(filterBits > 0, "FILTER_BITS " + std::to_string(filterBits));
    define(true, "PLANES " + std::to_string(planeCount));
    return text;
}

} // namespace render
} // namespace osgVolumizer
