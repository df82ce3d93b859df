#pragma once

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <chrono>
#include <thread>

namespace osgVolumizer {
namespace support {

/// Waits until the sampling for an error tolerance of an appearance has been chosen, as frames do;
/// false where it takes minutes. Expects a VolumeGeometry among its children.
inline bool waitForChoice(const VolumeAppearance& appearance)
{
    const VolumeGeometry* geometry = nullptr;
    for (unsigned i = 0; i < appearance.getNumChildren() && !geometry; ++i)
        geometry = dynamic_cast<const VolumeGeometry*>(appearance.getChild(i));
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    while (geometry && appearance.getSettingsInForce(*geometry).refining) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return geometry != nullptr;
}

} // namespace support
} // namespace osgVolumizer
