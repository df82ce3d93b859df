#pragma once

#include "Volumes.h"

#include <string>
#include <vector>

namespace osgVolumizer {
namespace test {

/// A volume of random values with a random table, looked at from random sides. A number always
/// stands for the same one.
struct PromiseCase
{
    int number = 0;
    std::string table; ///< kind
    std::string field; ///< kind, and what else is special about the voxels
    TwinVolume twin;
    std::vector<support::RenderOptions> views; ///< perspective, perspective, orthographic
};

constexpr int PROMISE_CASES = 200;

/// From 0 to PROMISE_CASES - 1.
PromiseCase makePromiseCase(int number);

} // namespace test
} // namespace osgVolumizer
