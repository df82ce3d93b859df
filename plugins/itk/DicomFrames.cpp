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

void applyOrder(const Elements& e, DicomFrame& frame)
{
    frame.order = {
        e.decimal(Tag(0x0020, 0x0100)).value_or(0.0), e.decimal(Tag(0x0018, 0x1060)).value_or(0.0),
        e.decimal(Tag(0x0018, 0x0081)).value_or(0.0), e.decimal(Tag(0x0020, 0x0012)).value_or(0.0),
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
    // One above the other, as far as nothing else is said.
    if (!each && !file.framesAreTime)
        for (DicomFrame& frame : frames)
            frame.position +=
                (first.thickness > 0.0 ? first.thickness : 1.0) * frame.frame * first.normal();
    return frames;
}

} // namespace medical
} // namespace osgVolumizer
