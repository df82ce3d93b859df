#pragma once

#include "PetScale.h"

#include <osgVolumizer/core/Status.h>

#include <gdcmDataSet.h>

#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace medical {

/// One picture of a DICOM file: where it lies (LPS, mm), and what its numbers mean.
struct DicomFrame
{
    int file = 0;  ///< of those that are read together
    int frame = 0; ///< within the file, from 0
    bool placed = false;
    glm::dvec3 position{0.0};                 ///< of the middle of the first pixel
    glm::dvec3 row{1, 0, 0}, column{0, 1, 0}; ///< where columns and rows go: unit vectors
    double columnStep = 1.0, rowStep = 1.0;   ///< mm between columns, between rows
    double thickness = 0.0;                   ///< mm to the next slice; 0: not said
    double slope = 1.0, intercept = 0.0;
    int segment = 1; ///< of a segmentation
    /// Which of several pictures of one place is first: temporal position, trigger time, echo,
    /// acquisition, time of acquisition, instance.
    std::array<double, 6> order{};

    glm::dvec3 normal() const;
};

/// What the header of a DICOM file says.
struct DicomFile
{
    std::int64_t pixelsAt = 0; ///< byte of the file where uncompressed pixels begin
    std::string path, series, description, modality, syntax;
    double seriesNumber = 0.0;
    int columns = 0, rows = 0, samples = 1;
    int allocated = 8, stored = 8, highBit = 7;
    bool isSigned = false;
    std::string photometric; ///< "MONOCHROME2", "RGB", ...
    bool isFloat = false;    ///< its pixels are floating-point numbers
    bool inverted = false;   ///< MONOCHROME1 of uncalibrated values: dark is dense as stored
    bool framesAreTime = false;
    std::vector<double> lut; ///< modality LUT: calibrated values from `lutFirst` on
    double lutFirst = 0.0;
    std::vector<double> palette[3]; ///< red, green, blue of each index from `paletteFirst` on
    double paletteFirst = 0.0;
    int paletteBits = 8;
    std::string instance;                             ///< its UID; or empty
    std::optional<std::pair<double, double>> padding; ///< stored values from ... to that are none
    bool isSegments = false; ///< bits, of the segment that a frame's slope is the number of
    std::optional<PetDose> pet;
    std::string note; ///< something that the reader should be told; or empty
    std::vector<DicomFrame> frames;

    bool colour() const { return samples >= 3 || photometric == "PALETTE COLOR"; }
};

/// Reads a file up to its pixels. Refuses, with a text that begins with the path, what is no DICOM
/// file (FILE_UNREADABLE) and what has no pixels (NOT_SUPPORTED).
Result<DicomFile> readDicomHeader(const std::string& path);

/// The frames of a file with the header `set`: parts of readDicomHeader().
std::vector<DicomFrame> dicomFramesOf(const gdcm::DataSet& set, int count, const DicomFile& file);
/// Whether a file can have the pixels of so many frames, before anything is decoded or allocated:
/// FILE_UNREADABLE; a text begins with the path.
Status checkPixelBytes(const DicomFile& file, std::int64_t frames);
/// Neither compressed nor deflated.
bool isPlainSyntax(const std::string& uid);

} // namespace medical
} // namespace osgVolumizer
