// Where the frames of a DICOM file lie, and how they are calibrated.

#include "DicomHeader.h"
#include "Elements.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgVolumizer {
namespace medical {

namespace {

using gdcm::Tag;

void applyMeasures(const Elements& e, DicomFrame& frame)
{
    std::vector<double> spacing = e.decimals(Tag(0x0028, 0x0030));
    if (spacing.size() < 2) spacing = e.decimals(Tag(0x0018, 0x1164)); // of the detector
    if (spacing.size() >= 2 && spacing[0] > 0.0 && spacing[1] > 0.0) {
        frame.rowStep = spacing[0]; // between rows comes first
        frame.columnStep = spacing[1];
    }
    const double between = std::abs(e.decimal(Tag(0x0018, 0x0088)).value_or(0.0));
    const double thick = std::abs(e.decimal(Tag(0x0018, 0x0050)).value_or(0.0));
    if (between > 0.0 || thick > 0.0) frame.thickness = between > 0.0 ? between : thick;
}

void applyOrientation(const Elements& e, DicomFrame& frame)
{
    const std::vector<double> o = e.decimals(Tag(0x0020, 0x0037));
    if (o.size() != 6) return;
    const glm::dvec3 row(o[0], o[1], o[2]), column(o[3], o[4], o[5]);
    const double lengths = glm::length(row) * glm::length(column);
    // What are no two directions is no orientation.
    if (!std::isfinite(lengths) || !(glm::length(glm::cross(row, column)) > 0.5 * lengths) ||
        !(lengths > 0.25 && lengths < 4.0))
        return;
    frame.row = glm::normalize(row);
    // At a right angle, but for rounding.
    frame.column = glm::normalize(column - glm::dot(column, frame.row) * frame.row);
}

void applyPosition(const Elements& e, DicomFrame& frame)
{
    const std::vector<double> p = e.decimals(Tag(0x0020, 0x0032));
    if (p.size() != 3) return;
    frame.position = {p[0], p[1], p[2]};
    frame.placed = true;
}

void applyRescale(const Elements& e, DicomFrame& frame)
{
    if (const auto slope = e.decimal(Tag(0x0028, 0x1053))) frame.slope = *slope;
    if (const auto intercept = e.decimal(Tag(0x0028, 0x1052))) frame.intercept = *intercept;
}

// Seconds since some day; 0 where it is not said.
double acquiredAt(const Elements& e)
{
    DicomMoment moment = DicomMoment::of(e.text(Tag(0x0008, 0x002a)));
    if (!moment.second)
        moment = DicomMoment::of(e.text(Tag(0x0008, 0x0022)), e.text(Tag(0x0008, 0x0032)));
    return moment.second ? 86400.0 * double(moment.day.value_or(0)) + *moment.second : 0.0;
}

void applyOrder(const Elements& e, DicomFrame& frame)
{
    frame.order = {e.decimal(Tag(0x0020, 0x0100)).value_or(0.0),
                   e.decimal(Tag(0x0018, 0x1060)).value_or(0.0),
                   e.decimal(Tag(0x0018, 0x0081)).value_or(0.0),
                   e.decimal(Tag(0x0020, 0x0012)).value_or(0.0),
                   acquiredAt(e),
                   e.decimal(Tag(0x0020, 0x0013)).value_or(0.0)};
}

// The functional groups of an enhanced file: what all frames share, or one has.
void applyGroups(const gdcm::DataSet& groups, DicomFrame& frame)
{
    const Elements e(groups);
    if (const auto item = e.item(Tag(0x0028, 0x9110))) applyMeasures(Elements(*item), frame);
    if (const auto item = e.item(Tag(0x0020, 0x9116))) applyOrientation(Elements(*item), frame);
    if (const auto item = e.item(Tag(0x0020, 0x9113))) applyPosition(Elements(*item), frame);
    if (const auto item = e.item(Tag(0x0028, 0x9145))) applyRescale(Elements(*item), frame);
    if (const auto item = e.item(Tag(0x0020, 0x9111))) {
        const Elements content(*item);
        frame.order[0] = content.longWord(Tag(0x0020, 0x9128)).value_or(0); // temporal position
    }
    if (const auto item = e.item(Tag(0x0062, 0x000a)))
        frame.segment = Elements(*item).word(Tag(0x0062, 0x000b)).value_or(0);
}

// Frames without a place of their own: one above the other, as far as nothing else is said. Of
// nuclear medicine the spacing can be negative, and which slice a frame is of can be told.
void stack(const Elements& e, std::vector<DicomFrame>& frames)
{
    const double thickness = frames.front().thickness > 0.0 ? frames.front().thickness : 1.0;
    const bool backwards = e.decimal(Tag(0x0018, 0x0088)).value_or(0.0) < 0.0;
    const std::vector<unsigned> slices = e.words(Tag(0x0054, 0x0080));
    for (DicomFrame& frame : frames) {
        const std::size_t i = static_cast<std::size_t>(frame.frame);
        const double index =
            slices.size() == frames.size() && slices[i] > 0 ? slices[i] - 1.0 : double(i);
        frame.position += (backwards ? -index : index) * thickness * frame.normal();
    }
}

// Of nuclear medicine, the first detector's.
void applyDetector(const Elements& e, DicomFrame& frame)
{
    const auto item = e.item(Tag(0x0054, 0x0022));
    if (!item || e.has(Tag(0x0020, 0x0032))) return;
    applyPosition(Elements(*item), frame);
    if (!e.has(Tag(0x0020, 0x0037))) applyOrientation(Elements(*item), frame);
}

// The frames of a dose: z from GridFrameOffsetVector, relative or absolute.
bool applyDose(const Elements& e, std::vector<DicomFrame>& frames)
{
    const std::vector<double> offsets = e.decimals(Tag(0x3004, 0x000c));
    if (const auto scale = e.decimal(Tag(0x3004, 0x000e)))
        for (DicomFrame& frame : frames)
            frame.slope = *scale;
    if (offsets.size() != frames.size()) return false;
    const glm::dvec3 first = frames.front().position, normal = frames.front().normal();
    const bool relative = offsets.front() == 0.0;
    for (std::size_t i = 0; i < frames.size(); ++i)
        frames[i].position =
            relative ? first + offsets[i] * normal : glm::dvec3(first.x, first.y, offsets[i]);
    return true;
}

} // namespace

glm::dvec3 DicomFrame::normal() const
{
    return glm::normalize(glm::cross(row, column));
}

std::vector<DicomFrame> dicomFramesOf(const gdcm::DataSet& set, int count, const DicomFile& file)
{
    const Elements e(set);
    DicomFrame first;
    applyMeasures(e, first);
    applyOrientation(e, first);
    applyPosition(e, first);
    applyDetector(e, first);
    applyRescale(e, first);
    applyOrder(e, first);
    if (const auto shared = e.item(Tag(0x5200, 0x9229))) applyGroups(*shared, first);
    std::vector<DicomFrame> frames(static_cast<std::size_t>(count), first);
    const std::vector<gdcm::DataSet> own = e.items(Tag(0x5200, 0x9230));
    const bool each = own.size() == frames.size();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].frame = static_cast<int>(i);
        if (each) applyGroups(own[i], frames[i]);
    }
    const bool dose = e.has(Tag(0x3004, 0x000c)) || e.has(Tag(0x3004, 0x000e));
    if (dose && applyDose(e, frames)) return frames;
    if (!each && !file.framesAreTime) stack(e, frames);
    if (file.isSegments)
        for (DicomFrame& frame : frames) {
            frame.slope = frame.segment;
            frame.intercept = 0.0;
        }
    return frames;
}

} // namespace medical
} // namespace osgVolumizer
