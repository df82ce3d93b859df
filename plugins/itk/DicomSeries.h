#pragma once

#include "DicomHeader.h"

namespace osgVolumizer {
namespace medical {

/// The frames of a series that make up a volume: those of its most frequent size and orientation;
/// where they lie beside each other in the plane (stations, tiles), those of a part of them.
struct DicomSeries
{
    std::string uid, description, modality;
    double number = 0.0;
    int columns = 0, rows = 0;
    std::vector<DicomFrame> frames;
    int setAside = 0; ///< frames of other sizes and orientations: scouts
    int part = 1, parts = 1;
    double voxels() const { return double(columns) * rows * double(frames.size()); }
};

/// The DICOM files of a folder.
struct DicomStudy
{
    std::vector<DicomFile> files;
    std::vector<DicomSeries> series; ///< by number
    int unread = 0;                  ///< files without pixels, or that cannot be read
    std::string firstReason;         ///< why that is, of the first of them
    int copies = 0;                  ///< files that there are already, left out
};

/// Reads the headers of files. Refused with the reason of the first file where none can be read.
Result<DicomStudy> readDicomStudy(const std::vector<std::string>& paths);

/// Which series is wanted: by its place in the list from 1, or else its SeriesNumber, its UID or
/// the end of it (behind a dot, or with one), or its description; the one of most voxels where
/// `wanted` is empty, and of parts of one series. VALUE_INVALID where there is no such one, or
/// several.
Result<std::size_t> chooseSeries(const DicomStudy& study, const std::string& wanted);

/// Where the slices of a volume lie, evenly.
struct DicomGrid
{
    /// Slice k of the volume: slice `lower` and, with `weight`, the one behind it.
    struct Slice
    {
        std::size_t lower = 0;
        double weight = 0.0;
        bool empty = false; ///< no segment has it
    };
    /// A picture of a segment that is laid over a slice of `steps`.
    struct Over
    {
        std::size_t slice = 0;
        DicomFrame frame;
    };

    std::vector<std::vector<DicomFrame>> steps; ///< of time: the slices of each, along the normal
    std::vector<Slice> slices;
    std::vector<Over> over;
    bool placed = false;
    glm::dvec3 position{0.0}, axes[3]; ///< LPS, mm: of sample 0, and to the next on each axis
    std::vector<std::string> notices;
};

/// Sorts the frames of a series. Missing slices and uneven distances are made good by linear
/// interpolation, and told in `notices`; a tilt is kept as a skewed axis. `like` is the file of one
/// of them: whether they are time, or segments.
DicomGrid layOut(const DicomSeries& series, const DicomFile& like);

/// The frames of each place along the normal, from the first to the last. Frames are placed.
std::vector<std::vector<DicomFrame>> placesAlong(std::vector<DicomFrame> frames);
/// The frames that lie beside others of the same place, each such part for itself.
std::vector<std::vector<DicomFrame>> stationsOf(const std::vector<DicomFrame>& frames);
/// The time steps that have a frame at each place, by what tells them apart: temporal position,
/// trigger, echo, acquisition, its time, instance; none where nothing does. `all`: with the others.
std::vector<std::vector<DicomFrame>> wholeSteps(const std::vector<std::vector<DicomFrame>>& places,
                                                std::size_t& all);

} // namespace medical
} // namespace osgVolumizer
