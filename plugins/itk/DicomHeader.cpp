#include "DicomHeader.h"

#include "Elements.h"
#include "Structure.h"

#include <osgVolumizer/core/RegularFile.h>

#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>
#include <gdcmUIDs.h>

#include <cmath>
#include <exception>
#include <filesystem>

namespace osgVolumizer {
namespace medical {

namespace {

using gdcm::Tag;

constexpr int MOST_FRAMES = 1 << 20;

// "has no pixels: it is an RT Plan Storage".
Status noPixels(const std::string& path, const Elements& elements, const gdcm::File& file)
{
    std::string uid = elements.text(Tag(0x0008, 0x0016));
    if (uid.empty()) uid = Elements(file.GetHeader()).text(Tag(0x0002, 0x0002));
    std::string text = path + " has no image";
    gdcm::UIDs uids;
    if (!uid.empty() && uids.SetFromUID(uid.c_str()) && uids.GetName())
        text += std::string(": it is of the kind \"") + uids.GetName() + '"';
    else if (const std::string modality = elements.text(Tag(0x0008, 0x0060)); !modality.empty())
        text += ": it is of modality " + modality;
    return {ErrorCode::NOT_SUPPORTED, text};
}

Status readLut(const Elements& elements, DicomFile& file)
{
    const std::optional<gdcm::DataSet> item = elements.item(Tag(0x0028, 0x3000));
    if (!item) return {};
    const Elements lut(*item);
    const std::vector<unsigned> head = lut.words(Tag(0x0028, 0x3002));
    std::vector<unsigned> data = lut.words(Tag(0x0028, 0x3006));
    const std::size_t count = head.size() < 3 || head[0] == 0 ? 65536 : head[0];
    if (head.size() < 3 || data.size() < count)
        return {ErrorCode::NOT_SUPPORTED,
                file.path + " has a modality table of a form that cannot be read"};
    file.lut.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(count));
    file.lutFirst = file.isSigned ? double(static_cast<std::int16_t>(head[1])) : double(head[1]);
    return {};
}

// GDCM asserts that a table is as long as its description says.
Status readPalette(const Elements& elements, DicomFile& file)
{
    if (file.photometric != "PALETTE COLOR") return {};
    for (std::uint16_t c = 0; c < 3; ++c) {
        const std::vector<unsigned> head = elements.words(Tag(0x0028, std::uint16_t(0x1101 + c)));
        const std::string data = elements.raw(Tag(0x0028, std::uint16_t(0x1201 + c)));
        const std::size_t count = head.size() < 3 || head[0] == 0 ? 65536 : head[0];
        const std::size_t bytes = data.size() / count;
        if (head.size() < 3 || data.size() != bytes * count || (bytes != 1 && bytes != 2) ||
            (head[2] != 8 && head[2] != 16) || (c > 0 && count != file.palette[0].size()))
            return {ErrorCode::NOT_SUPPORTED,
                    file.path + " has a palette of a form that cannot be read"};
        file.paletteFirst = head[1];
        file.paletteBits = bytes == 1 ? 8 : static_cast<int>(head[2]);
        for (std::size_t i = 0; i < count; ++i) {
            const auto low = static_cast<unsigned char>(data[i * bytes]);
            const auto high = static_cast<unsigned char>(data[i * bytes + bytes - 1]);
            file.palette[c].push_back(bytes == 1 ? low : low | high << 8);
        }
    }
    return {};
}

Status readLayout(const Elements& elements, DicomFile& file)
{
    const auto word = [&](int element, int otherwise) {
        return elements.word(Tag(0x0028, std::uint16_t(element))).value_or(otherwise);
    };
    file.rows = word(0x10, 0);
    file.columns = word(0x11, 0);
    file.samples = word(0x02, 1);
    file.allocated = word(0x100, file.isFloat ? 32 : 16);
    file.stored = word(0x101, file.allocated);
    file.highBit = word(0x102, file.stored - 1);
    file.isSigned = word(0x103, 0) == 1;
    file.photometric = elements.text(Tag(0x0028, 0x0004));
    const auto refuse = [&file](const std::string& what) {
        return Status(ErrorCode::VALUE_INVALID, file.path + " has " + what);
    };
    if (file.rows < 1 || file.columns < 1)
        return refuse(std::to_string(file.columns) + " columns and " + std::to_string(file.rows) +
                      " rows");
    if (file.samples != 1 && file.samples != 3 && file.samples != 4)
        return refuse(std::to_string(file.samples) + " samples a pixel");
    if (file.stored < 1 || file.stored > file.allocated || file.highBit >= file.allocated ||
        file.highBit + 1 < file.stored || file.allocated > 64)
        return refuse(std::to_string(file.stored) + " bits up to bit " +
                      std::to_string(file.highBit) + " in words of " +
                      std::to_string(file.allocated));
    return {};
}

void readWords(const Elements& elements, DicomFile& file)
{
    file.series = elements.text(Tag(0x0020, 0x000e));
    file.instance = elements.text(Tag(0x0008, 0x0018));
    file.description = elements.text(Tag(0x0008, 0x103e));
    file.modality = elements.text(Tag(0x0008, 0x0060));
    file.seriesNumber = elements.decimal(Tag(0x0020, 0x0011)).value_or(0.0);
    // FrameIncrementPointer: to a frame's duration.
    const std::vector<unsigned> pointer = elements.words(Tag(0x0028, 0x0009));
    file.framesAreTime = pointer.size() >= 2 && pointer[0] == 0x0018 &&
                         (pointer[1] == 0x1063 || pointer[1] == 0x1065);
}

void calibrate(const gdcm::DataSet& set, DicomFile& file)
{
    const Elements elements(set);
    bool calibrated = !file.lut.empty();
    for (const DicomFrame& frame : file.frames)
        calibrated = calibrated || frame.slope != 1.0 || frame.intercept != 0.0;
    file.inverted = file.photometric == "MONOCHROME1" && !calibrated;
    if (file.modality == "PT") file.pet = petDoseOf(set);
}

// Whether decoded values may be others than were encoded.
bool isLossy(const Elements& elements, const DicomFile& file)
{
    if (elements.text(Tag(0x0028, 0x2110)) == "01") return true;
    const std::string family = "1.2.840.10008.1.2.4.";
    for (const char* end : {"50", "51", "81", "91"})
        if (file.syntax == family + end) return true;
    return false;
}

// Of pixels that are no part of the picture.
void readPadding(const Elements& elements, DicomFile& file)
{
    if (file.isFloat || file.colour()) return;
    const auto numberAt = [&](const Tag& tag) -> std::optional<double> {
        const std::optional<int> word = elements.word(tag);
        if (!word) return std::nullopt;
        return file.isSigned ? double(static_cast<std::int16_t>(*word)) : double(*word);
    };
    const std::optional<double> value = numberAt(Tag(0x0028, 0x0120));
    if (!value) return;
    const std::optional<double> limit = numberAt(Tag(0x0028, 0x0121));
    if (!limit && isLossy(elements, file)) return; // only near the value
    const double other = limit.value_or(*value);
    file.padding = {std::min(*value, other), std::max(*value, other)};
}

// Which pictures of a segmentation can be read: those of bits, a segment each.
Status readSegments(const Elements& elements, DicomFile& file)
{
    if (elements.text(Tag(0x0008, 0x0016)) != "1.2.840.10008.5.1.4.1.1.66.4") return {};
    file.isSegments = file.allocated == 1;
    if (file.isSegments || elements.items(Tag(0x0062, 0x0002)).size() < 2) return {};
    return {ErrorCode::NOT_SUPPORTED,
            file.path + " has several segments of fractions, which are no labels"};
}

Result<DicomFile> readHeader(const std::string& path)
{
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(Tag(0x7fe0, 0x0010), {Tag(0x7fe0, 0x0010)}))
        return Status(ErrorCode::FILE_UNREADABLE,
                      path + " cannot be read as DICOM: its elements are cut short, or of a form "
                             "that GDCM does not read");
    const gdcm::DataSet& set = reader.GetFile().GetDataSet();
    const Elements elements(set);
    DicomFile file;
    file.path = path;
    const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    if (const char* name = syntax.GetString()) file.syntax = name;
    if (!elements.has(Tag(0x0028, 0x0010)) && !elements.has(Tag(0x0028, 0x0011)))
        return noPixels(path, elements, reader.GetFile());
    file.pixelsAt = static_cast<std::int64_t>(reader.GetStreamCurrentPosition());
    file.isFloat = elements.has(Tag(0x7fe0, 0x0008)) || elements.has(Tag(0x7fe0, 0x0009));
    readWords(elements, file);
    Status status = readLayout(elements, file);
    if (status.ok()) status = readLut(elements, file);
    if (status.ok()) status = readPalette(elements, file);
    if (!status.ok()) return status;
    if (status = readSegments(elements, file); !status.ok()) return status;
    readPadding(elements, file);
    const double frames = elements.decimal(Tag(0x0028, 0x0008)).value_or(1.0);
    if (!(frames >= 1.0 && frames <= MOST_FRAMES))
        return Status(ErrorCode::VALUE_INVALID,
                      path + " has " + std::to_string(frames) + " frames");
    // Of single frames when they are read: a series without one of them is refused, not filled.
    if (frames > 1.0)
        if (status = checkPixelBytes(file, std::int64_t(frames)); !status.ok()) return status;
    file.frames = dicomFramesOf(set, static_cast<int>(frames), file);
    for (const DicomFrame& frame : file.frames)
        if (frame.slope == 0.0)
            return Status(ErrorCode::VALUE_INVALID, path + " has a rescale slope of 0");
    calibrate(set, file);
    return file;
}

} // namespace

Result<DicomFile> readDicomHeader(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    if (Status status = checkStructure(path); !status.ok()) return status;
    try {
        return readHeader(path);
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE, path + " cannot be read as DICOM: " + e.what());
    }
}

} // namespace medical
} // namespace osgVolumizer
