#include "DicomPixels.h"

#include "RunLengths.h"

#include <osgVolumizer/io/Brightness.h>

#include <gdcmPixmapReader.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmUIDs.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>

namespace osgVolumizer {
namespace medical {

namespace {

using gdcm::Tag;

/// A constant image of JPEG 2000 comes near this.
constexpr std::int64_t HIGHEST_FACTOR = 1 << 16;

std::string syntaxName(const std::string& uid)
{
    gdcm::UIDs uids;
    if (!uid.empty() && uids.SetFromUID(uid.c_str()) && uids.GetName()) return uids.GetName();
    return uid;
}

// Of all pixels as they are stored without compression. Sizes are 16 bits each, frames 20.
std::int64_t neededBytes(const DicomFile& file, std::int64_t frames)
{
    const std::int64_t pixels = std::int64_t(file.columns) * file.rows * frames;
    const std::int64_t bits = pixels * file.samples * file.allocated;
    return ((file.photometric == "YBR_FULL_422" ? bits / 3 * 2 : bits) + 7) / 8;
}

// Each frame has a fragment with a head of its own, but in films.
std::int64_t leastCompressed(const DicomFile& file, std::int64_t frames)
{
    constexpr std::int64_t FRAGMENT_HEAD = 8;
    const std::int64_t bytes = neededBytes(file, frames) / HIGHEST_FACTOR;
    const std::string films = "1.2.840.10008.1.2.4.10"; // MPEG and its followers
    const bool film = file.syntax.compare(0, films.size(), films) == 0;
    const bool deflated = file.syntax == "1.2.840.10008.1.2.1.99";
    return film || deflated ? bytes : std::max(bytes, FRAGMENT_HEAD * frames);
}

} // namespace

bool isPlainSyntax(const std::string& uid)
{
    const gdcm::TransferSyntax syntax(gdcm::TransferSyntax::GetTSType(uid.c_str()));
    return !syntax.IsEncapsulated() &&
           syntax != gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
}

Status checkPixelBytes(const DicomFile& file, std::int64_t frames)
{
    const bool plain = isPlainSyntax(file.syntax);
    std::error_code failed;
    const auto all = static_cast<std::int64_t>(std::filesystem::file_size(file.path, failed));
    const std::int64_t found = plain && !file.isFloat ? all - file.pixelsAt : all;
    const std::int64_t needed = plain ? neededBytes(file, frames) : leastCompressed(file, frames);
    if (!failed && needed <= found) return {};
    return {ErrorCode::FILE_UNREADABLE,
            file.path + " has " + std::to_string(found) + " bytes of pixels, which need " +
                (plain ? "" : "even compressed ") + std::to_string(needed)};
}

namespace {

Status undecoded(const DicomFile& file, const gdcm::File& read, bool whole)
{
    const gdcm::DataSet& set = read.GetDataSet();
    if (whole && !set.FindDataElement(Tag(0x7fe0, 0x0010)))
        return {ErrorCode::NOT_SUPPORTED, file.path + " has no pixels, though it says their size"};
    const std::string how = syntaxName(file.syntax);
    return {ErrorCode::FILE_UNREADABLE,
            file.path + " has pixels that cannot be decoded" +
                (how.empty() ? how : " (" + how + ")") +
                ": they are cut short, damaged or of a form that GDCM does not read"};
}

// Pixels of floating-point numbers, which GDCM takes for no image.
bool takeFloats(const gdcm::DataSet& set, const DicomFile& file, bool plain,
                std::vector<char>& bytes, int& allocated)
{
    for (const int bits : {32, 64}) {
        const Tag tag(0x7fe0, bits == 32 ? 0x0008 : 0x0009);
        const gdcm::ByteValue* value =
            set.FindDataElement(tag) ? set.GetDataElement(tag).GetByteValue() : nullptr;
        const std::size_t needed = std::size_t(file.columns) * std::size_t(file.rows) *
                                   file.frames.size() * std::size_t(bits / 8);
        if (!value || !plain || value->GetLength() < needed) continue;
        bytes.assign(value->GetPointer(), value->GetPointer() + needed);
        allocated = bits;
        return true;
    }
    return false;
}

// One fragment for each frame.
bool decodeRle(const gdcm::Bitmap& image, const DicomFile& file, std::vector<char>& bytes)
{
    const gdcm::SequenceOfFragments* parts = image.GetDataElement().GetSequenceOfFragments();
    const int bytesPerSample = file.allocated / 8;
    const std::size_t pixels = std::size_t(file.columns) * std::size_t(file.rows);
    const std::size_t frameBytes = pixels * std::size_t(file.samples * bytesPerSample);
    if (!parts || parts->GetNumberOfFragments() != file.frames.size() ||
        bytes.size() < frameBytes * file.frames.size())
        return false;
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        const gdcm::ByteValue* part = parts->GetFragment(static_cast<unsigned>(i)).GetByteValue();
        if (!part || !decodeRunLengths(part->GetPointer(), part->GetLength(), file.samples,
                                       bytesPerSample, pixels, bytes.data() + i * frameBytes))
            return false;
    }
    return true;
}

} // namespace

Status DicomPixels::open(const DicomFile& file)
{
    const gdcm::TransferSyntax syntax(gdcm::TransferSyntax::GetTSType(file.syntax.c_str()));
    const bool plain = isPlainSyntax(file.syntax);
    if (Status status = checkPixelBytes(file, std::int64_t(file.frames.size())); !status.ok())
        return status;
    // No reader of images with their places, which asserts that some elements are there.
    gdcm::PixmapReader reader;
    reader.SetFileName(file.path.c_str());
    if (!reader.Read()) {
        _float = takeFloats(reader.GetFile().GetDataSet(), file, plain, _bytes, _allocated);
        return _float ? Status() : undecoded(file, reader.GetFile(), true);
    }
    const gdcm::Bitmap* image = &reader.GetPixmap();
    const gdcm::PixelFormat& format = image->GetPixelFormat();
    _allocated = format.GetBitsAllocated();
    _storedBits = format.GetBitsStored();
    _highBit = format.GetHighBit();
    _signed = format.GetPixelRepresentation() == 1;
    if (_allocated == file.allocated && plain) {
        _storedBits = file.stored;
        _highBit = file.highBit;
    }
    _samples = format.GetSamplesPerPixel();
    _planar = image->GetPlanarConfiguration() == 1 && _samples > 1;
    const auto colours = image->GetPhotometricInterpretation();
    _ybr = colours == gdcm::PhotometricInterpretation::YBR_FULL ||
           colours == gdcm::PhotometricInterpretation::YBR_FULL_422;
    const std::size_t values = std::size_t(file.columns) * std::size_t(file.rows) *
                               file.frames.size() * std::size_t(_samples);
    if (_allocated != 1 && _allocated != 8 && _allocated != 16 && _allocated != 32)
        return {ErrorCode::NOT_SUPPORTED,
                file.path + " has pixels of " + std::to_string(_allocated) + " bits"};
    const std::size_t needed = _allocated == 1 ? (values + 7) / 8 : values * _allocated / 8;
    if (image->GetColumns() != unsigned(file.columns) || image->GetRows() != unsigned(file.rows) ||
        (_allocated != 1 && image->GetBufferLength() < needed))
        return {ErrorCode::FILE_UNREADABLE, file.path + " has fewer pixels than its header says"};
    _bytes.resize(std::max<std::size_t>(image->GetBufferLength(), needed));
    const bool mixed =
        syntax == gdcm::TransferSyntax::RLELossless && _samples > 1 && _allocated > 8;
    if (mixed) _planar = false;
    // GDCM takes the lowest bits for the stored ones, and so clears others.
    const gdcm::ByteValue* raw = image->GetDataElement().GetByteValue();
    if (plain && _highBit + 1 != _storedBits && raw && raw->GetLength() >= _bytes.size()) {
        std::copy_n(raw->GetPointer(), _bytes.size(), _bytes.begin());
        return {};
    }
    if (!(mixed ? decodeRle(*image, file, _bytes) : image->GetBuffer(_bytes.data())))
        return undecoded(file, reader.GetFile(), false);
    // GDCM turns words of 16 bits round, whatever they are part of.
    if (syntax == gdcm::TransferSyntax::ExplicitVRBigEndian && _allocated == 32)
        for (std::size_t i = 0; i + 4 <= _bytes.size(); i += 4)
            std::swap_ranges(&_bytes[i], &_bytes[i] + 2, &_bytes[i + 2]);
    return {};
}

double DicomPixels::stored(std::size_t index) const
{
    if (_float) {
        float narrow = 0.0f;
        double wide = 0.0;
        if (_allocated == 64)
            std::memcpy(&wide, _bytes.data() + 8 * index, 8);
        else
            std::memcpy(&narrow, _bytes.data() + 4 * index, 4);
        return _allocated == 64 ? wide : double(narrow);
    }
    if (_allocated == 1) return (_bytes[index / 8] >> (index % 8)) & 1;
    std::uint32_t word = 0;
    if (_allocated == 8)
        word = static_cast<unsigned char>(_bytes[index]);
    else if (_allocated == 16) {
        std::uint16_t half = 0;
        std::memcpy(&half, _bytes.data() + 2 * index, 2);
        word = half;
    } else {
        std::memcpy(&word, _bytes.data() + 4 * index, 4);
    }
    word >>= _highBit + 1 - _storedBits;
    if (_storedBits < 32) word &= (1u << _storedBits) - 1u;
    const bool negative = _signed && (word >> (_storedBits - 1) & 1);
    return negative ? double(word) - std::ldexp(1.0, _storedBits) : double(word);
}

double DicomPixels::colour(std::size_t pixel, std::size_t pixelsPerFrame, int channel) const
{
    const std::size_t frame = pixel / pixelsPerFrame, within = pixel % pixelsPerFrame;
    const auto samples = static_cast<std::size_t>(_samples);
    double rgb[4] = {};
    for (std::size_t s = 0; s < samples; ++s)
        rgb[s] =
            stored(_planar ? (frame * samples + s) * pixelsPerFrame + within : pixel * samples + s);
    if (_ybr) {
        const double y = rgb[0], middle = std::ldexp(1.0, _storedBits - 1), cb = rgb[1] - middle,
                     cr = rgb[2] - middle, most = std::ldexp(1.0, _storedBits) - 1.0;
        const auto held = [most](double v) { return std::clamp(std::round(v), 0.0, most); };
        rgb[0] = held(y + 1.402 * cr);
        rgb[1] = held(y - (0.114 * 1.772 * cb + 0.299 * 1.402 * cr) / 0.587);
        rgb[2] = held(y + 1.772 * cb);
    }
    return channel >= 0 ? rgb[channel] : io::brightness(rgb, 3);
}

Status DicomPixels::readFrame(const DicomFile& file, const DicomFrame& frame, int channel,
                              std::vector<double>& values) const
{
    const std::size_t count = std::size_t(file.columns) * std::size_t(file.rows);
    const std::size_t first = count * std::size_t(frame.frame);
    values.resize(count);
    if (!file.palette[0].empty()) {
        const double end = double(file.palette[0].size()) - 1.0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto index = static_cast<std::size_t>(
                std::clamp(stored(first + i) - file.paletteFirst, 0.0, end));
            const double rgb[3] = {file.palette[0][index], file.palette[1][index],
                                   file.palette[2][index]};
            values[i] = channel >= 0 ? rgb[channel] : io::brightness(rgb, 3);
        }
        return {};
    }
    if (_samples > 1) {
        for (std::size_t i = 0; i < count; ++i)
            values[i] = colour(first + i, count, channel);
        return {};
    }
    const double lowest = _signed ? -std::ldexp(1.0, _storedBits - 1) : 0.0;
    const double highest = lowest + std::ldexp(1.0, _storedBits) - 1.0;
    const double last = double(file.lut.size()) - 1.0;
    for (std::size_t i = 0; i < count; ++i) {
        double v = stored(first + i);
        if (file.padding && v >= file.padding->first && v <= file.padding->second) {
            values[i] = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        if (file.inverted) v = lowest + highest - v;
        if (!file.lut.empty())
            v = file.lut[static_cast<std::size_t>(std::clamp(v - file.lutFirst, 0.0, last))];
        else
            v = frame.slope * v + frame.intercept;
        values[i] = v;
    }
    return {};
}

} // namespace medical
} // namespace osgVolumizer
