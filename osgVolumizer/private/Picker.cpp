#include "Picker.h"

namespace osgVolumizer {

namespace {

Picker*& installedPicker()
{
    static Picker* picker = nullptr;
    return picker;
}

} // namespace

void setPicker(Picker* picker)
{
    installedPicker() = picker;
}

Picker* getPicker()
{
    return installedPicker();
}

} // namespace osgVolumizer
