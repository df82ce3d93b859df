#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace osgVolumizer {
namespace core {

/// IEEE 754 binary16, as stored in memory. Conversion from float rounds to nearest, ties to even.
struct Half
{
    std::uint16_t bits = 0;

    Half() = default;
    explicit Half(float value) : bits(encode(value)) {}
    operator float() const { return decode(bits); }

    static float decode(std::uint16_t half)
    {
        // Moving exponent and mantissa into place leaves the exponent's bias to correct; a float
        // subtraction renormalises denormals.
        constexpr std::uint32_t exponentMask = 0x7c00u << 13;
        std::uint32_t word = (half & 0x7fffu) << 13;
        const std::uint32_t exponent = word & exponentMask;
        word += (127u - 15u) << 23;
        float value;
        if (exponent == exponentMask) {
            word += (128u - 16u) << 23; // infinity or NaN
            std::memcpy(&value, &word, 4);
        } else if (exponent == 0) {
            word += 1u << 23;
            std::memcpy(&value, &word, 4);
            value -= 6.103515625e-05f; // 2^-14
        } else {
            std::memcpy(&value, &word, 4);
        }
        return half & 0x8000u ? -value : value;
    }

    static std::uint16_t encode(float value)
    {
        std::uint32_t word;
        std::memcpy(&word, &value, 4);
        const std::uint16_t sign = static_cast<std::uint16_t>((word >> 16) & 0x8000u);
        word &= 0x7fffffffu;
        std::uint32_t half;
        if (word > 0x7f800000u)
            half = 0x7e00u; // NaN
        else if (word >= 0x477ff000u)
            half = 0x7c00u; // rounds beyond 65504
        else if (word < 0x38800000u)
            half = static_cast<std::uint32_t>(std::lrint(std::ldexp(std::fabs(value), 24)));
        else
            half = (word - ((127u - 15u) << 23) + 0xfffu + ((word >> 13) & 1u)) >> 13;
        return static_cast<std::uint16_t>(sign | half);
    }
};

} // namespace core
} // namespace osgVolumizer
