// With the environment variable OSGVOLUMIZER_TEST_FILTER_BITS=8 the tests of this program run as on
// a card whose texture units filter with weights of so many bits. All of them are meant to pass.

#include <osgVolumizer/render/context/ContextLimits.h>

#include <cstdlib>

namespace {

[[maybe_unused]] const bool asked = [] {
    const char* bits = std::getenv("OSGVOLUMIZER_TEST_FILTER_BITS");
    if (bits) osgVolumizer::render::setFilterBits(std::atoi(bits));
    return bits != nullptr;
}();

} // namespace
