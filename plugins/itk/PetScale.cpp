// Standardised uptake values by body weight.

#include "PetScale.h"

#include "DicomHeader.h"
#include "Elements.h"

#include <osgVolumizer/core/Text.h>

#include <cmath>

namespace osgVolumizer {
namespace medical {

namespace {

using gdcm::Tag;

constexpr double SECONDS_OF_DAY = 86400.0;

bool isDigits(const std::string& text, std::size_t count)
{
    return text.size() >= count &&
           text.substr(0, count).find_first_not_of("0123456789") == std::string::npos;
}

// "HHMMSS.frac", and perhaps a zone behind, which is left alone.
std::optional<double> secondsOf(std::string time)
{
    const std::size_t zone = time.find_first_of("+-&");
    if (zone != std::string::npos) time.resize(zone);
    double seconds = 0.0;
    if (!isDigits(time, 6) || !core::parseNumber(time.substr(4), seconds)) return std::nullopt;
    return 3600.0 * std::stoi(time.substr(0, 2)) + 60.0 * std::stoi(time.substr(2, 2)) + seconds;
}

// "YYYYMMDD", and perhaps more.
std::optional<std::int64_t> dayOf(const std::string& date)
{
    if (!isDigits(date, 8)) return std::nullopt;
    std::int64_t year = std::stoi(date.substr(0, 4)), month = std::stoi(date.substr(4, 2));
    const std::int64_t day = std::stoi(date.substr(6, 2));
    if (month < 1 || month > 12 || day < 1 || day > 31) return std::nullopt;
    // Years that begin in March end with a leap day.
    year -= month < 3;
    month = (month + 9) % 12;
    return 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
}

/// Seconds from `a` to `b`, by their days where both have one.
double secondsBetween(const DicomMoment& a, const DicomMoment& b)
{
    const double seconds = *b.second - *a.second;
    return a.day && b.day ? SECONDS_OF_DAY * double(*b.day - *a.day) + seconds : seconds;
}

// When the scan began: as its series says, or the first picture, where that was earlier.
DicomMoment scanOf(const std::vector<const DicomFile*>& files)
{
    DicomMoment scan = files.front()->pet->series;
    for (const DicomFile* file : files) {
        const DicomMoment& acquired = file->pet->acquired;
        if (!acquired.second) continue;
        if (!scan.second || (acquired.day.has_value() == scan.day.has_value() &&
                             secondsBetween(scan, acquired) < 0.0))
            scan = acquired;
    }
    return scan;
}

std::optional<double> scaleAt(const PetDose& pet, const DicomMoment& scan, std::string& reason)
{
    constexpr double MOST_WITHOUT_DATES = 43200.0, MOST_HALF_LIVES = 10.0;
    if (pet.isUptake) return 1.0;
    reason = pet.refusal;
    if (!reason.empty()) return std::nullopt;
    if (!(pet.halfLife > 0.0)) return pet.scale;
    reason = "the times of injection and scan are not known";
    if (!pet.given.second || !scan.second) return std::nullopt;
    double seconds = secondsBetween(pet.given, scan);
    const bool dated = pet.given.day && scan.day;
    if (!dated && seconds < 0.0) seconds += SECONDS_OF_DAY; // past midnight
    reason = "the scan is earlier than the injection";
    if (seconds < 0.0) return std::nullopt;
    reason = "without dates, there seem to be more than 12 hours from the injection to the scan";
    if (!dated && seconds > MOST_WITHOUT_DATES) return std::nullopt;
    reason = "there are more than 10 half lives from the injection to the scan";
    if (seconds > MOST_HALF_LIVES * pet.halfLife) return std::nullopt;
    return pet.scale * std::exp2(seconds / pet.halfLife);
}

} // namespace

DicomMoment DicomMoment::of(const std::string& date, const std::string& time)
{
    return {secondsOf(time), dayOf(date)};
}

DicomMoment DicomMoment::of(const std::string& dateTime)
{
    if (!dayOf(dateTime) || dateTime.size() < 14) return {};
    return of(dateTime, dateTime.substr(8));
}

PetDose petDoseOf(const gdcm::DataSet& set)
{
    const Elements e(set);
    PetDose pet;
    const auto refuse = [&pet](const char* why) {
        pet.refusal = why;
        return pet;
    };
    pet.isUptake = e.text(Tag(0x0054, 0x1001)) == "GML";
    if (pet.isUptake) return pet;
    if (e.text(Tag(0x0054, 0x1001)) != "BQML") return refuse("their unit is not Bq/ml");
    const double weight = e.decimal(Tag(0x0010, 0x1030)).value_or(0.0); // kg
    if (!(weight > 0.0)) return refuse("the weight of the patient is not known");
    const std::optional<gdcm::DataSet> item = e.item(Tag(0x0054, 0x0016));
    if (!item) return refuse("the radiopharmaceutical is not known");
    const Elements drug(*item);
    const double dose = drug.decimal(Tag(0x0018, 0x1074)).value_or(0.0); // Bq
    if (!(dose > 0.0)) return refuse("the injected dose is not known");
    pet.scale = 1000.0 * weight / dose;
    const std::string correction = e.text(Tag(0x0054, 0x1102));
    if (correction == "ADMIN") return pet;
    if (correction != "START") return refuse("they are not corrected for decay to a known time");
    pet.halfLife = drug.decimal(Tag(0x0018, 0x1075)).value_or(0.0);
    if (!(pet.halfLife > 0.0)) return refuse("the half life is not known");
    pet.given = DicomMoment::of(drug.text(Tag(0x0018, 0x1078)));
    if (!pet.given.second) pet.given = DicomMoment::of("", drug.text(Tag(0x0018, 0x1072)));
    pet.series = DicomMoment::of(e.text(Tag(0x0008, 0x0021)), e.text(Tag(0x0008, 0x0031)));
    pet.acquired = DicomMoment::of(e.text(Tag(0x0008, 0x0022)), e.text(Tag(0x0008, 0x0032)));
    return pet;
}

void scalePet(std::vector<DicomFile>& files, const std::string& uid)
{
    std::vector<const DicomFile*> all;
    for (const DicomFile& file : files)
        if (file.pet && file.series == uid) all.push_back(&file);
    if (all.empty()) return;
    const DicomMoment scan = scanOf(all);
    std::vector<double> scales;
    std::string note, reason;
    for (const DicomFile* file : all) {
        const std::optional<double> scale = scaleAt(*file->pet, scan, reason);
        if (!scale && note.empty()) note = "PET values are as stored, no SUV: " + reason;
        scales.push_back(scale.value_or(1.0));
    }
    auto scale = scales.begin();
    for (DicomFile& file : files) {
        if (!file.pet || file.series != uid) continue;
        file.note = note;
        for (DicomFrame& frame : file.frames) {
            frame.slope *= note.empty() ? *scale : 1.0;
            frame.intercept *= note.empty() ? *scale : 1.0;
        }
        ++scale;
    }
}

} // namespace medical
} // namespace osgVolumizer
