#pragma once

#include <osg/StateSet>

#include <functional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace test {

/// What a state above a volume does to it.
enum class Effect
{
    AS_ON_GEOMETRY, ///< what it does to translucent geometry in the same place
    NONE,           ///< nothing, on purpose
    NONE_YET        ///< nothing, though it could
};

/// What can show a state.
enum class Target
{
    ANY,     ///< RGBA32F and RGBA8 with one sample
    BYTE,    ///< RGBA8 with one sample
    SAMPLES, ///< RGBA8 with four samples
};

/// With which scenes a state can be shown.
enum class Scope
{
    ALL,
    VOLUMES,  ///< surfaces under it are not merged with volumes, or OSG itself mixes it up for them
    ELSEWHERE ///< none: flat geometry cannot stand for volumes; a test of its own shows it
};

/// One state of OSG: a row of the table in the documentation, and a case of the tests.
struct StateRow
{
    std::string state; ///< as in the table; unique
    /// Puts it into a state set, in force with `value` (ON, perhaps with OVERRIDE).
    std::function<void(osg::StateSet&, unsigned value)> set;
    Effect effect = Effect::NONE;
    bool shows = true; ///< whether translucent geometry in the test's scene changes with it
    std::string why;   ///< for the table: what it means, or why not
    Target target = Target::ANY;
    Scope scope = Scope::ALL;
    bool driverDecides = false; ///< `shows` holds of the software rasteriser only
};

/// All rows, in the order of the table.
const std::vector<StateRow>& stateRows();

/// The rows of one kind each, in the order of stateRows().
std::vector<StateRow> fragmentRows();
std::vector<StateRow> sampleRows();
std::vector<StateRow> primitiveRows();
std::vector<StateRow> spaceRows();
std::vector<StateRow> shadingRows();
std::vector<StateRow> textureRows();
std::vector<StateRow> bufferRows();

/// Shorthands for rows.
inline unsigned off(unsigned value)
{
    return value & ~unsigned(osg::StateAttribute::ON);
}
template <class Attribute, class... Arguments>
std::function<void(osg::StateSet&, unsigned)> with(Arguments... arguments)
{
    return [=](osg::StateSet& set, unsigned value) {
        set.setAttributeAndModes(new Attribute(arguments...), value);
    };
}
inline std::function<void(osg::StateSet&, unsigned)> mode(GLenum name, bool on = true)
{
    return [=](osg::StateSet& set, unsigned value) { set.setMode(name, on ? value : off(value)); };
}

} // namespace test
} // namespace osgVolumizer
