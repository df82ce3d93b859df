#pragma once

#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// Where the samples of an axis of a variable lie.
struct Axis
{
    int dimension = -1;             ///< of the variable; -1: it has none, and one sample
    int samples = 1;                ///< in the file
    int size = 1;                   ///< of the volume
    double first = 0.0, step = 1.0; ///< of the volume's samples, in `unit`
    bool known = false;             ///< the file says where they lie
    /// Where sample i of the volume lies among those of the file, as a fraction of an index; empty
    /// where it is sample i.
    std::vector<double> places;
    std::string name, unit;
};

/// Lets longitudes that cross the date line, and so jump by a turn, go on beyond it: 170, 180, 190.
/// Others, and whatever neither rises nor falls then, stay as they are.
void unwrapDegrees(std::vector<double>& values);

/// Places the samples of an axis at coordinates, one for each, which rise or fall: as they are
/// where they lie evenly, to 1e-4 of a step or what numbers of `precision` can tell; else the axis
/// gets an even grid as fine as the smallest gap, but at most `most` samples. What is done about
/// uneven ones, or ones that are no coordinates at all, is added to `notices`.
void placeSamples(Axis& axis, const std::vector<double>& coordinates, double precision, int most,
                  std::vector<std::string>& notices);

/// Samples of a file along an axis that are read together, and where they go.
struct Run
{
    int start = 0, stride = 1, count = 1; ///< in the file
    int to = 0;
};
/// What of an axis has to be read for samples [min, max) of a level.
struct Fetch
{
    std::vector<Run> runs;
    int count = 0; ///< of all runs together
    /// Of which two of those each sample is made, a fraction of an index; empty where sample i is
    /// the one with number i.
    std::vector<double> places;
};
/// Of coarser levels the sample in the middle, as VoxelSource::readThinned().
Fetch fetchOf(const Axis& axis, int min, int max, int level);

} // namespace gdal
} // namespace osgVolumizer
