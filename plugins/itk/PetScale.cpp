// Standardised uptake values by body weight.

#include "DicomHeader.h"
#include "Elements.h"

#include <cmath>

namespace osgVolumizer {
namespace medical {

namespace {

using gdcm::Tag;

/// Seconds since midnight of "HHMMSS.frac", or of the end of "YYYYMMDDHHMMSS.frac".
std::optional<double> secondsOf(std::string time, bool withDate)
{
    if (withDate) time = time.size() >= 14 ? time.substr(8) : std::string();
    const std::size_t zone = time.find_first_of("+-&");
    if (zone != std::string::npos) time.resize(zone);
    if (time.size() < 6 || time.find_first_not_of("0123456789.") != std::string::npos)
        return std::nullopt;
    return 3600.0 * std::stoi(time.substr(0, 2)) + 60.0 * std::stoi(time.substr(2, 2)) +
           std::stod(time.substr(4));
}

} // namespace

std::optional<double> petScale(const gdcm::DataSet& set, std::string& reason)
{
    const Elements e(set);
    const auto refuse = [&reason](const char* why) {
        reason = why;
        return std::optional<double>();
    };
    if (e.text(Tag(0x0054, 0x1001)) != "BQML") return refuse("their unit is not Bq/ml");
    const double weight = e.decimal(Tag(0x0010, 0x1030)).value_or(0.0); // kg
    if (!(weight > 0.0)) return refuse("the weight of the patient is not known");
    const std::optional<gdcm::DataSet> item = e.item(Tag(0x0054, 0x0016));
    if (!item) return refuse("the radiopharmaceutical is not known");
    const Elements drug(*item);
    const double dose = drug.decimal(Tag(0x0018, 0x1074)).value_or(0.0); // Bq
    if (!(dose > 0.0)) return refuse("the injected dose is not known");
    const std::string correction = e.text(Tag(0x0054, 0x1102));
    if (correction == "ADMIN") return 1000.0 * weight / dose;
    if (correction != "START") return refuse("they are not corrected for decay to a known time");
    const double halfLife = drug.decimal(Tag(0x0018, 0x1075)).value_or(0.0); // s
    if (!(halfLife > 0.0)) return refuse("the half life is not known");
    std::optional<double> given = secondsOf(drug.text(Tag(0x0018, 0x1072)), false);
    if (!given) given = secondsOf(drug.text(Tag(0x0018, 0x1078)), true);
    const std::optional<double> scanned = secondsOf(e.text(Tag(0x0008, 0x0031)), false);
    if (!given || !scanned) return refuse("the times of injection and scan are not known");
    double seconds = *scanned - *given;
    if (seconds < 0.0) seconds += 86400.0; // past midnight
    return 1000.0 * weight / (dose * std::exp2(-seconds / halfLife));
}

} // namespace medical
} // namespace osgVolumizer
