#pragma once

#include "DicomHeader.h"

namespace osgVolumizer {
namespace medical {

/// The frames of a series that make up a volume: those of its most frequent size and orientation.
struct DicomSeries
{
    std::string uid, description, modality;
    double number = 0.0;
    int columns = 0, rows = 0;
    std::vector<DicomFrame> frames;
    int setAside = 0; ///< frames of other sizes and orientations: scouts
    double voxels() const { return double(columns) * rows * double(frames.size()); }
};

/// The DICOM files of a folder.
struct DicomStudy
{
    std::vector<DicomFile> files;
    std::vector<DicomSeries> series; ///< by number
    int unread = 0;                  ///< files without pixels, or that cannot be read
    std::string firstReason;         ///< why that is, of the first of them
};

/// Reads the headers of files. Refused with the reason of the first file where none can be read.
Result<DicomStudy> readDicomStudy(const std::vector<std::string>& paths);

/// Which series is wanted: by its number from 1, its UID or the end of it, or its description; the
/// one of most voxels where `wanted` is empty. VALUE_INVALID where there is no such one, or
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
    };

    std::vector<std::vector<DicomFrame>> steps; ///< of time: the slices of each, along the normal
    std::vector<Slice> slices;
    bool placed = false;
    glm::dvec3 position{0.0}, axes[3]; ///< LPS, mm: of sample 0, and to the next on each axis
    std::vector<std::string> notices;
};

/// Sorts the frames of a series. Missing slices and uneven distances are made good by linear
/// interpolation, and told in `notices`; a tilt is kept as a skewed axis.
DicomGrid layOut(const DicomSeries& series, bool framesAreTime);

} // namespace medical
} // namespace osgVolumizer
