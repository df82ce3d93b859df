#include "AppearanceProperties.h"

#include "core/NumberRule.h"
#include "core/Text.h"

#include <osgDB/FileNameUtils>

#include <cmath>
#include <limits>
#include <type_traits>

namespace osgVolumizer {

namespace {

using A = VolumeAppearance;
using Property = AppearanceProperty;
using Values = Property::Values;

Property make(const char* name, const char* option, const char* help, Property::Kind kind)
{
    Property property{};
    property.name = name;
    property.option = option;
    property.help = help;
    property.kind = kind;
    property.count = 1;
    property.since = 1;
    return property;
}

Property sinceVersion(int version, Property property)
{
    property.since = version;
    return property;
}

template <auto Get, auto Set, int Count>
Property choice(const char* name, const char* option, const char* help,
                const char* const (&names)[Count])
{
    using Enum = std::decay_t<std::invoke_result_t<decltype(Get), const A&>>;
    Property p = make(name, option, help, Property::CHOICE);
    p.choices.assign(names, names + Count);
    p.get = [](const A& a) { return Values{double((a.*Get)())}; };
    p.expected = [](std::size_t, double v) -> std::string {
        return v >= 0 && v < Count && v == std::floor(v) ? "" : "the number of a choice";
    };
    p.set = [](A& a, const Values& v) { (a.*Set)(static_cast<Enum>(int(v[0]))); };
    return p;
}

template <auto Get, auto Set>
Property flag(const char* name, const char* option, const char* help)
{
    Property p = make(name, option, help, Property::FLAG);
    p.get = [](const A& a) { return Values{(a.*Get)() ? 1.0 : 0.0}; };
    p.expected = [](std::size_t, double v) -> std::string {
        return v == 0.0 || v == 1.0 ? "" : "0 or 1";
    };
    p.set = [](A& a, const Values& v) { (a.*Set)(v[0] == 1.0); };
    return p;
}

template <auto Get, auto Set>
Property number(const char* name, const char* option, const char* help,
                const core::NumberRule& rule)
{
    Property p = make(name, option, help, Property::NUMBERS);
    p.get = [](const A& a) { return Values{(a.*Get)()}; };
    p.expected = [&rule](std::size_t, double v) -> std::string {
        return rule.holds(v) ? "" : rule.expected;
    };
    p.set = [](A& a, const Values& v) { (a.*Set)(v[0]); };
    return p;
}

Property samplingPeriod()
{
    Property p = make("SamplingPeriod", "period",
                      "distance between samples along the view, in voxels", Property::NUMBERS);
    p.count = 3;
    p.get = [](const A& a) {
        const osg::Vec3d v = a.getSamplingPeriod();
        return Values{v.x(), v.y(), v.z()};
    };
    p.expected = [](std::size_t, double v) -> std::string {
        return core::LENGTH.holds(v) ? "" : core::LENGTH.expected;
    };
    p.set = [](A& a, const Values& v) { a.setSamplingPeriod(osg::Vec3d(v[0], v[1], v[2])); };
    return p;
}

Property maximumSamples()
{
    Property p =
        make("MaximumSamples", "samples", "bound on the samples along a ray", Property::INTEGER);
    p.get = [](const A& a) { return Values{double(a.getMaximumSamples())}; };
    p.expected = [](std::size_t, double v) -> std::string {
        constexpr int most = std::numeric_limits<int>::max();
        return v >= 1.0 && v <= most ? "" : "a whole number from 1 to " + std::to_string(most);
    };
    p.set = [](A& a, const Values& v) { a.setMaximumSamples(int(v[0])); };
    return p;
}

Property material()
{
    Property p = make("Material", "material", "ambient, diffuse, specular coefficient, shininess",
                      Property::NUMBERS);
    p.count = 4;
    p.get = [](const A& a) {
        const A::Material& m = a.getMaterial();
        return Values{m.ambient, m.diffuse, m.specular, m.shininess};
    };
    p.expected = [](std::size_t i, double v) -> std::string {
        const core::NumberRule& rule = i < 3 ? core::COEFFICIENT : core::SHININESS;
        return rule.holds(v) ? "" : rule.expected;
    };
    p.set = [](A& a, const Values& v) { a.setMaterial({v[0], v[1], v[2], v[3]}); };
    return p;
}

Property accumulationBits()
{
    Property p =
        make("AccumulationBits", "bits", "bits per channel to accumulate in", Property::INTEGER);
    p.get = [](const A& a) { return Values{double(a.getAccumulationBits())}; };
    p.expected = [](std::size_t, double v) -> std::string {
        return v == 8.0 || v == 16.0 || v == 32.0 ? "" : "8, 16 or 32";
    };
    p.set = [](A& a, const Values& v) { a.setAccumulationBits(int(v[0])); };
    return p;
}

const char* const TECHNIQUES[] = {"AUTOMATIC", "SLICES", "SLABS"};
const char* const INTERPOLATIONS[] = {"NEAREST", "LINEAR", "CUBIC"};
const char* const LOOKUPS[] = {"AUTOMATIC_LOOKUP", "AFTER_INTERPOLATION", "BEFORE_INTERPOLATION",
                               "PREINTEGRATED", "CELL_BY_CELL"};
const char* const MODES[] = {"VIEWPORT_ALIGNED", "AXIS_ALIGNED", "SPHERICAL"};
const char* const RULES[] = {"ABSORB", "PAINT"};
const char* const GRADIENTS[] = {"ON_THE_FLY", "PRECOMPUTED"};
const char* const SPACES[] = {"VIEW_VOLUME", "OBJECT", "PRIMITIVE"};

std::vector<Property> makeProperties()
{
    return {
        choice<&A::getTechnique, &A::setTechnique>("Technique", "technique",
                                                   "how the volume is drawn", TECHNIQUES),
        choice<&A::getInterpolation, &A::setInterpolation>(
            "Interpolation", "interpolation", "of values between samples", INTERPOLATIONS),
        sinceVersion(
            2, choice<&A::getLookup, &A::setLookup>(
                   "Lookup", "lookup", "in the table, before or after interpolation", LOOKUPS)),
        sinceVersion(2, flag<&A::getExactFiltering, &A::setExactFiltering>(
                            "ExactFiltering", "exact", "interpolation in 32-bit floats")),
        choice<&A::getSamplingMode, &A::setSamplingMode>("SamplingMode", "mode",
                                                         "shape of the slices", MODES),
        choice<&A::getSamplingSpace, &A::setSamplingSpace>("SamplingSpace", "space",
                                                           "that slices are counted in", SPACES),
        samplingPeriod(),
        maximumSamples(),
        number<&A::getOpacityUnit, &A::setOpacityUnit>(
            "OpacityUnit", "unit",
            "thickness that the table's opacity is for, in object units; 0: of a voxel",
            core::LENGTH_OR_NONE),
        sinceVersion(3, choice<&A::getRayFunction, &A::setRayFunction>(
                            "RayFunction", "ray", "what a pixel shows of the values on its ray",
                            A::RAY_FUNCTION_NAMES)),
        sinceVersion(3, number<&A::getIsoValue, &A::setIsoValue>(
                            "IsoValue", "iso", "data value of the isosurface", core::FINITE)),
        sinceVersion(3, flag<&A::getShading, &A::setShading>("Shading", "shading",
                                                             "light from the scene's lights")),
        sinceVersion(3, material()),
        sinceVersion(3, choice<&A::getGradients, &A::setGradients>(
                            "Gradients", "gradients", "where light gets its normals", GRADIENTS)),
        sinceVersion(3, accumulationBits()),
        sinceVersion(
            4, choice<&A::getCombineRule, &A::setCombineRule>(
                   "CombineRule", "combine", "what it does to volumes that overlap it", RULES)),
        sinceVersion(3, number<&A::getErrorTolerance, &A::setErrorTolerance>(
                            "ErrorTolerance", "tolerance",
                            "root mean square error that chooses the period; 0: none",
                            core::NOT_NEGATIVE)),
        sinceVersion(3, number<&A::getTargetFrameTime, &A::setTargetFrameTime>(
                            "TargetFrameTime", "frametime",
                            "seconds that a frame may take while the view moves; 0: any",
                            core::NOT_NEGATIVE)),
        sinceVersion(5, number<&A::getTimeStep, &A::setTimeStep>(
                            "TimeStep", "step", "time step at the beginning", core::FINITE)),
        sinceVersion(5, number<&A::getTimeRate, &A::setTimeRate>(
                            "TimeRate", "rate", "time steps a second", core::FINITE)),
        sinceVersion(5, flag<&A::getTimeBlending, &A::setTimeBlending>(
                            "TimeBlending", "blending", "of values between time steps")),
        sinceVersion(6, number<&A::getPickOpacity, &A::setPickOpacity>(
                            "PickOpacity", "pick",
                            "opacity in front of a place where a click finds the volume",
                            core::PICK_OPACITY)),
    };
}

Status unexpected(const Property& p, std::string_view text, const std::string& expected)
{
    return {ErrorCode::VALUE_INVALID,
            std::string(p.option) + " is \"" + std::string(text) + "\", expected " + expected};
}

// The number of a name; -1 for none.
int choiceOf(const Property& p, const std::string& text)
{
    for (std::size_t i = 0; i < p.choices.size(); ++i) {
        const std::string name = osgDB::convertToLowerCase(p.choices[i]);
        const bool automatic = name.compare(0, 9, "automatic") == 0;
        if (text == name || (automatic && (text == "auto" || text == "automatic")))
            return static_cast<int>(i);
    }
    return -1;
}

int flagOf(const std::string& text)
{
    for (const char* on : {"on", "1", "true", "yes"})
        if (text == on) return 1;
    for (const char* off : {"off", "0", "false", "no"})
        if (text == off) return 0;
    return -1;
}

} // namespace

const std::vector<AppearanceProperty>& appearanceProperties()
{
    static const std::vector<Property> properties = makeProperties();
    return properties;
}

const AppearanceProperty* findAppearanceOption(std::string_view option)
{
    for (const Property& p : appearanceProperties())
        if (option == p.option) return &p;
    return nullptr;
}

Result<Values> parseAppearanceValues(const AppearanceProperty& p, std::string_view text)
{
    if (p.kind == Property::CHOICE || p.kind == Property::FLAG) {
        const std::string word = osgDB::convertToLowerCase(std::string(text));
        const int value = p.kind == Property::FLAG ? flagOf(word) : choiceOf(p, word);
        if (value < 0) return unexpected(p, text, "one of " + appearanceValueText(p));
        return Values{double(value)};
    }
    Values values(p.count);
    if (p.count == 3 && core::parseNumbers(text, values.data(), 1))
        values.assign(3, values.front());
    else if (!core::parseNumbers(text, values.data(), int(p.count)))
        return unexpected(p, text, appearanceValueText(p));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool whole = p.kind != Property::INTEGER || values[i] == std::floor(values[i]);
        const std::string expected = whole ? p.expected(i, values[i]) : "a whole number";
        if (!expected.empty()) return unexpected(p, text, expected);
    }
    return values;
}

std::string appearanceValueText(const AppearanceProperty& p)
{
    if (p.kind == Property::FLAG) return "on, off";
    if (p.kind == Property::INTEGER) return "a whole number";
    if (p.kind == Property::NUMBERS)
        return p.count == 1 ? "a number" : p.count == 3 ? "x or x,y,z" : "four numbers a,b,c,d";
    std::string text;
    for (const char* name : p.choices)
        text += (text.empty() ? "" : ", ") + osgDB::convertToLowerCase(name);
    return text;
}

} // namespace osgVolumizer
