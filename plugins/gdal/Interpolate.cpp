#include "Interpolate.h"

#include <cmath>

namespace osgVolumizer {
namespace gdal {

namespace {

int countOf(const Fetch& fetch)
{
    return fetch.places.empty() ? fetch.count : int(fetch.places.size());
}

double mixed(double a, double b, double fraction)
{
    if (std::isnan(a) || std::isnan(b)) return fraction < 0.5 ? a : b;
    return a + fraction * (b - a);
}

struct Place
{
    int below;
    double fraction; ///< from there to the next
};

Place placeOf(const Fetch& fetch, int i)
{
    if (fetch.places.empty()) return {i, 0.0};
    const double place = fetch.places[std::size_t(i)];
    return {int(place), place - int(place)};
}

} // namespace

void interpolate(const double* samples, const Fetch (&fetch)[3], double* destination)
{
    const std::size_t row = std::size_t(fetch[0].count), slice = row * fetch[1].count;
    for (int k = 0; k < countOf(fetch[2]); ++k)
        for (int j = 0; j < countOf(fetch[1]); ++j)
            for (int i = 0; i < countOf(fetch[0]); ++i) {
                const Place x = placeOf(fetch[0], i), y = placeOf(fetch[1], j),
                            z = placeOf(fetch[2], k);
                const double* at = samples + z.below * slice + y.below * row + x.below;
                const auto alongX = [&x](const double* p) {
                    return x.fraction > 0.0 ? mixed(p[0], p[1], x.fraction) : p[0];
                };
                const auto alongY = [&](const double* p) {
                    return y.fraction > 0.0 ? mixed(alongX(p), alongX(p + row), y.fraction)
                                            : alongX(p);
                };
                *destination++ = z.fraction > 0.0
                                     ? mixed(alongY(at), alongY(at + slice), z.fraction)
                                     : alongY(at);
            }
}

} // namespace gdal
} // namespace osgVolumizer
