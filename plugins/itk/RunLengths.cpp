#include "RunLengths.h"

#include <cstdint>
#include <cstring>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr std::size_t HEAD = 64; // a count, and places of at most 15 segments

// PackBits: to every `step`th byte of `destination`.
bool unpack(const unsigned char* from, const unsigned char* end, std::size_t count,
            std::size_t step, char* destination)
{
    std::size_t done = 0;
    while (done < count) {
        if (end - from < 2) return false;
        const int control = static_cast<signed char>(*from++);
        if (control == -128) continue;
        const std::size_t run = static_cast<std::size_t>(control < 0 ? 1 - control : 1 + control);
        if (control >= 0 && end - from < static_cast<std::ptrdiff_t>(run)) return false;
        for (std::size_t i = 0; i < run && done < count; ++i)
            destination[step * done++] = static_cast<char>(control < 0 ? *from : from[i]);
        from += control < 0 ? 1 : run;
    }
    return true;
}

} // namespace

bool decodeRunLengths(const char* data, std::size_t size, int samples, int bytesPerSample,
                      std::size_t pixels, char* destination)
{
    const int segments = samples * bytesPerSample;
    if (size < HEAD || segments > 15) return false;
    std::uint32_t head[HEAD / 4];
    std::memcpy(head, data, HEAD);
    if (head[0] != static_cast<std::uint32_t>(segments)) return false;
    const auto* bytes = reinterpret_cast<const unsigned char*>(data);
    for (int s = 0; s < segments; ++s) {
        const std::size_t begin = head[s + 1], end = s + 1 < segments ? head[s + 2] : size;
        if (begin < HEAD || begin > end || end > size) return false;
        const int sample = s / bytesPerSample, byte = bytesPerSample - 1 - s % bytesPerSample;
        if (!unpack(bytes + begin, bytes + end, pixels, static_cast<std::size_t>(segments),
                    destination + sample * bytesPerSample + byte))
            return false;
    }
    return true;
}

} // namespace medical
} // namespace osgVolumizer
