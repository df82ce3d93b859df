// Which pictures lie at one place, and which beside each other.

#include "DicomSeries.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace medical {

namespace {

/// Pictures that follow each other along the normal.
struct Station
{
    std::vector<DicomFrame> frames;
    bool grew = false; ///< at the place that is looked at
};

/// Of one place, those that lie on each other.
using Spot = std::vector<DicomFrame>;

glm::dvec3 across(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& normal)
{
    const glm::dvec3 way = to - from;
    return way - glm::dot(way, normal) * normal;
}

std::vector<Spot> spotsOf(const Spot& place, const glm::dvec3& normal)
{
    const double pixel = std::min(place.front().columnStep, place.front().rowStep);
    std::vector<Spot> spots;
    for (const DicomFrame& frame : place) {
        const auto spot = std::find_if(spots.begin(), spots.end(), [&](const Spot& s) {
            return glm::length(across(s.front().position, frame.position, normal)) <= pixel;
        });
        if (spot == spots.end())
            spots.push_back({frame});
        else
            spot->push_back(frame);
    }
    return spots;
}

// Each spot to the station that is nearest to it, a station one spot.
void grow(std::vector<Station>& stations, const std::vector<Spot>& spots, const glm::dvec3& normal)
{
    struct Pair
    {
        double distance;
        std::size_t spot, station;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < spots.size(); ++i)
        for (std::size_t j = 0; j < stations.size(); ++j)
            pairs.push_back({glm::length(across(stations[j].frames.back().position,
                                                spots[i].front().position, normal)),
                             i, j});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    std::vector<bool> placed(spots.size(), false);
    for (Station& station : stations)
        station.grew = false;
    for (const Pair& pair : pairs) {
        Station& station = stations[pair.station];
        if (placed[pair.spot] || station.grew) continue;
        placed[pair.spot] = station.grew = true;
        station.frames.insert(station.frames.end(), spots[pair.spot].begin(),
                              spots[pair.spot].end());
    }
    for (std::size_t i = 0; i < spots.size(); ++i)
        if (!placed[i]) stations.push_back({spots[i], true});
}

} // namespace

std::vector<std::vector<DicomFrame>> placesAlong(std::vector<DicomFrame> frames)
{
    constexpr double EXACT = 1e-3;    // mm
    constexpr double OF_GAP = 0.02;   // of the distance between slices
    constexpr double OF_PIXEL = 0.05; // nearer than that no slices are
    const glm::dvec3 normal = frames.front().normal();
    const auto along = [&normal](const DicomFrame& f) { return glm::dot(f.position, normal); };
    std::stable_sort(frames.begin(), frames.end(),
                     [&](const DicomFrame& a, const DicomFrame& b) { return along(a) < along(b); });
    const double pixel = std::min(frames.front().columnStep, frames.front().rowStep);
    std::vector<double> gaps, wide;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i)
        if (const double gap = along(frames[i + 1]) - along(frames[i]); gap > EXACT) {
            gaps.push_back(gap);
            if (gap > OF_PIXEL * pixel) wide.push_back(gap);
        }
    if (wide.empty()) wide = gaps;
    std::sort(wide.begin(), wide.end());
    const double tolerance = wide.empty() ? EXACT : std::max(EXACT, OF_GAP * wide[wide.size() / 2]);
    std::vector<std::vector<DicomFrame>> places;
    for (const DicomFrame& frame : frames) {
        if (places.empty() || along(frame) - along(places.back().front()) > tolerance)
            places.emplace_back();
        places.back().push_back(frame);
    }
    return places;
}

std::vector<std::vector<DicomFrame>> stationsOf(const std::vector<DicomFrame>& frames)
{
    constexpr std::size_t MOST_BESIDE = 256;
    if (!frames.front().placed || frames.size() < 2) return {frames};
    const glm::dvec3 normal = frames.front().normal();
    std::vector<std::vector<Spot>> all;
    bool beside = false;
    for (const Spot& place : placesAlong(frames)) {
        all.push_back(spotsOf(place, normal));
        beside = beside || all.back().size() > 1;
        if (all.back().size() > MOST_BESIDE) return {frames};
    }
    if (!beside) return {frames};
    std::vector<Station> stations;
    for (const std::vector<Spot>& spots : all)
        grow(stations, spots, normal);
    std::vector<std::vector<DicomFrame>> parts;
    for (Station& station : stations)
        parts.push_back(std::move(station.frames));
    return parts;
}

} // namespace medical
} // namespace osgVolumizer
