#pragma once

#include <cstdint>
#include <string>

namespace osgVolumizer {
namespace vtk {

/// Counts the cells of a grid that are not shown, by the reason.
class CellTally
{
public:
    enum Reason
    {
        FACES,      ///< points, lines and faces
        NO_VOLUME,  ///< all of whose points lie in a plane
        REPEATED,   ///< of less than four different points
        NOT_FINITE, ///< values that are NaN or beyond single precision
        HIDDEN,     ///< that the file marks as hidden
        UNKNOWN,    ///< kinds that VTK cannot interpolate in, or does not know
        REASONS
    };

    void add(Reason reason) { ++_counts[reason]; }
    std::int64_t count(Reason reason) const { return _counts[reason]; }
    /// "12 points, lines or faces, 3 without a volume"; empty where there are none.
    std::string text() const
    {
        static const char* const words[REASONS] = {"points, lines or faces", "without a volume",
                                                   "of repeated points",     "of values not finite",
                                                   "marked as hidden",       "of unknown kinds"};
        std::string all;
        for (int r = 0; r < REASONS; ++r)
            if (_counts[r] > 0)
                all += (all.empty() ? "" : ", ") + std::to_string(_counts[r]) + " " + words[r];
        return all;
    }

private:
    std::int64_t _counts[REASONS] = {};
};

} // namespace vtk
} // namespace osgVolumizer
