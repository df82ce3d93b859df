#pragma once

#include "VolumeAppearance.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace osgVolumizer {

/// A property of VolumeAppearance, for whoever sets it by its name: scene files, options of the
/// loader, tools.
struct AppearanceProperty
{
    /// How its values are to be taken.
    enum Kind
    {
        CHOICE, ///< one value, the number of a name
        FLAG,   ///< one value, 0 or 1
        INTEGER,
        NUMBERS
    };
    using Values = std::vector<double>;

    const char* name;   ///< in scene files: "SamplingPeriod"
    const char* option; ///< in option strings: "period"
    const char* help;   ///< what it is, with its unit
    Kind kind;
    std::vector<const char*> choices; ///< of CHOICE
    std::size_t count;                ///< of values
    int since;                        ///< version of scene files that have it first
    std::function<Values(const VolumeAppearance&)> get;
    /// What value number `index` should be instead; "" where `value` is allowed.
    std::function<std::string(std::size_t index, double value)> expected;
    /// To `count` values for which expected() is "".
    std::function<void(VolumeAppearance&, const Values&)> set;
};

/// All properties but voxels and lookup table, in the order of scene files.
OSGVOLUMIZER_EXPORT const std::vector<AppearanceProperty>& appearanceProperties();
/// The property of that option, or null.
OSGVOLUMIZER_EXPORT const AppearanceProperty* findAppearanceOption(std::string_view option);

/// The values that a text stands for: names of choices and on or off in any case, numbers between
/// commas; of three numbers one may stand for all. VALUE_INVALID, with what is expected, for
/// anything else.
OSGVOLUMIZER_EXPORT Result<AppearanceProperty::Values>
parseAppearanceValues(const AppearanceProperty& property, std::string_view text);
/// What may be written for a property: "composite, maximum, ...", "on, off", "x | x,y,z".
OSGVOLUMIZER_EXPORT std::string appearanceValueText(const AppearanceProperty& property);

} // namespace osgVolumizer
