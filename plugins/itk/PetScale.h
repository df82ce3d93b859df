#pragma once

#include <gdcmDataSet.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace medical {

struct DicomFile;

/// A time of day, and its day where that is said.
struct DicomMoment
{
    std::optional<double> second;    ///< since midnight
    std::optional<std::int64_t> day; ///< since some day

    /// Of "YYYYMMDD" and "HHMMSS.frac".
    static DicomMoment of(const std::string& date, const std::string& time);
    /// Of "YYYYMMDDHHMMSS.frac".
    static DicomMoment of(const std::string& dateTime);
};

/// What a PET picture says of the dose.
struct PetDose
{
    bool isUptake = false; ///< its values are SUV already
    std::string refusal;   ///< why there is no SUV; or empty
    double scale = 1.0;    ///< from Bq/ml to body weight SUV at the time that the dose was given
    double halfLife = 0.0; ///< s; 0: values are corrected for decay to that time
    DicomMoment given, series, acquired;
};

PetDose petDoseOf(const gdcm::DataSet& set);

/// Turns the PET files of the series `uid` into body weight SUV: all of them, or else none, which
/// their notes say with the reason.
void scalePet(std::vector<DicomFile>& files, const std::string& uid);

} // namespace medical
} // namespace osgVolumizer
