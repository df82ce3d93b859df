#include "DicomHeader.h"

#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <vector>

namespace osgVolumizer {
namespace io {

namespace {

constexpr std::uint32_t UNDEFINED_LENGTH = 0xffffffffu;
constexpr std::uint32_t ITEM_END = 0xfffee00du, SEQUENCE_END = 0xfffee0ddu;
constexpr std::uint32_t PIXEL_DATA = 0x7fe00010u;
constexpr int MAXIMUM_DEPTH = 16;             // of sequences
constexpr std::uint32_t MAXIMUM_VALUE = 1024; // bytes of a value that we look at

struct Element
{
    std::uint32_t tag = 0;
    std::uint32_t length = 0;
};

/// Walks the elements of a file.
class Elements
{
public:
    explicit Elements(std::istream& file) : _file(file)
    {
        _file.seekg(0, std::ios::end);
        _end = static_cast<std::int64_t>(_file.tellg());
        _file.seekg(132);
    }
    std::int64_t position() { return static_cast<std::int64_t>(_file.tellg()); }
    std::int64_t left() { return _end - position(); }
    void setImplicit() { _implicit = true; }

    /// False at the end, or where no whole element is left.
    bool next(Element& e)
    {
        unsigned char head[8];
        if (!take(head, 8)) return false;
        e.tag = word(head) << 16 | word(head + 2);
        const bool delimiter = e.tag >> 16 == 0xfffe;
        if (delimiter || (_implicit && e.tag >> 16 != 2)) {
            e.length = word(head + 4) | word(head + 6) << 16;
            return true;
        }
        const std::string vr(reinterpret_cast<const char*>(head) + 4, 2);
        static const std::string longForms = "OB OW OF OD OL OV SQ UN UC UR UT SV UV";
        if (longForms.find(vr) == std::string::npos) {
            e.length = word(head + 6);
            return true;
        }
        unsigned char length[4];
        if (!take(length, 4)) return false;
        e.length = word(length) | word(length + 2) << 16;
        return true;
    }
    /// The value of an element as bytes; false where the file ends first.
    bool value(const Element& e, std::string& bytes)
    {
        if (e.length > MAXIMUM_VALUE || e.length > left()) return false;
        bytes.resize(e.length);
        return take(&bytes[0], e.length);
    }
    bool skip(const Element& e, int depth = 0)
    {
        if (e.length != UNDEFINED_LENGTH) {
            if (e.length > left()) return false;
            _file.seekg(e.length, std::ios::cur);
            return true;
        }
        // Undefined length: until its delimiter, through whatever is nested in it.
        if (depth == MAXIMUM_DEPTH) return false;
        for (Element inner; next(inner);) {
            if (inner.tag == SEQUENCE_END || inner.tag == ITEM_END) return true;
            if (!skip(inner, depth + 1)) return false;
        }
        return false;
    }

    static std::uint32_t word(const void* bytes)
    {
        const auto* b = static_cast<const unsigned char*>(bytes);
        return static_cast<std::uint32_t>(b[0] | b[1] << 8);
    }

private:
    bool take(void* to, std::int64_t bytes)
    {
        return bytes <= left() && static_cast<bool>(_file.read(static_cast<char*>(to), bytes));
    }

    std::istream& _file;
    std::int64_t _end = 0;
    bool _implicit = false;
};

/// The numbers of a text value, "1.5\2.5", as far as they are numbers.
std::vector<double> numbersOf(const std::string& text)
{
    std::vector<double> numbers;
    for (const std::string_view piece : core::splitText(text, '\\')) {
        const auto words = core::splitBlanks(piece.substr(0, piece.find('\0')));
        double number = 0.0;
        if (words.size() != 1 || !core::parseNumber(words[0], number) || !std::isfinite(number))
            break;
        numbers.push_back(number);
    }
    return numbers;
}

// The elements that matter, by group and number.
constexpr std::uint32_t TRANSFER_SYNTAX = 0x00020010u, SLICE_THICKNESS = 0x00180050u;
constexpr std::uint32_t SPACING_BETWEEN_SLICES = 0x00180088u, SERIES = 0x0020000eu;
constexpr std::uint32_t INSTANCE_NUMBER = 0x00200013u;
constexpr std::uint32_t IMAGE_POSITION = 0x00200032u, IMAGE_ORIENTATION = 0x00200037u;
constexpr std::uint32_t SAMPLES_PER_PIXEL = 0x00280002u, NUMBER_OF_FRAMES = 0x00280008u;
constexpr std::uint32_t ROWS = 0x00280010u, COLUMNS = 0x00280011u, PIXEL_SPACING = 0x00280030u;
constexpr std::uint32_t BITS_ALLOCATED = 0x00280100u, BITS_STORED = 0x00280101u;
constexpr std::uint32_t HIGH_BIT = 0x00280102u, PIXEL_REPRESENTATION = 0x00280103u;
constexpr std::uint32_t RESCALE_INTERCEPT = 0x00281052u, RESCALE_SLOPE = 0x00281053u;

/// The values of the elements at the top level, as they are stored.
class Values
{
public:
    static bool wants(std::uint32_t tag)
    {
        return tag == TRANSFER_SYNTAX || tag == SLICE_THICKNESS || tag == SPACING_BETWEEN_SLICES ||
               tag == SERIES || (tag >= INSTANCE_NUMBER && tag <= IMAGE_ORIENTATION) ||
               (tag >= SAMPLES_PER_PIXEL && tag <= RESCALE_SLOPE);
    }
    std::string& operator[](std::uint32_t tag) { return _values[tag]; }

    /// A 16-bit number.
    int number(std::uint32_t tag, int otherwise) const
    {
        const auto v = _values.find(tag);
        return v == _values.end() || v->second.size() < 2
                   ? otherwise
                   : static_cast<int>(Elements::word(v->second.data()));
    }
    std::vector<double> decimals(std::uint32_t tag) const
    {
        const auto v = _values.find(tag);
        return v == _values.end() ? std::vector<double>() : numbersOf(v->second);
    }
    double decimal(std::uint32_t tag, double otherwise) const
    {
        const std::vector<double> n = decimals(tag);
        return n.empty() ? otherwise : n[0];
    }
    std::string text(std::uint32_t tag) const
    {
        const auto v = _values.find(tag);
        if (v == _values.end()) return {};
        return v->second.substr(0, v->second.find_last_not_of(std::string("\0 ", 2)) + 1);
    }

private:
    std::map<std::uint32_t, std::string> _values;
};

/// Millimetres along the normal of the slice, as far as the file says how it lies.
std::optional<double> positionOf(const Values& values)
{
    const std::vector<double> p = values.decimals(IMAGE_POSITION);
    const std::vector<double> a = values.decimals(IMAGE_ORIENTATION);
    if (p.size() != 3 || a.size() != 6) return std::nullopt;
    return (a[1] * a[5] - a[2] * a[4]) * p[0] + (a[2] * a[3] - a[0] * a[5]) * p[1] +
           (a[0] * a[4] - a[1] * a[3]) * p[2];
}

/// Directions of the columns' index, the rows' index and their normal; identity where the file does
/// not say, or says what are no two directions at a right angle.
glm::dmat3 axesOf(const Values& values)
{
    const std::vector<double> a = values.decimals(IMAGE_ORIENTATION);
    if (a.size() != 6) return glm::dmat3(1.0);
    const glm::dvec3 x(a[0], a[1], a[2]), y(a[3], a[4], a[5]);
    const double lengths = glm::length(x) * glm::length(y);
    if (!(lengths > 0.0) || !std::isfinite(lengths) ||
        !(std::fabs(glm::dot(x, y)) < 1e-3 * lengths))
        return glm::dmat3(1.0);
    const glm::dvec3 first = glm::normalize(x), normal = glm::normalize(glm::cross(x, y));
    return {first, glm::cross(normal, first), normal};
}

Status check(const DicomHeader& h, int samplesPerPixel, const std::string& name)
{
    const auto refuse = [&](ErrorCode code, const std::string& what) {
        return Status(code, name + ": " + what);
    };
    if (samplesPerPixel != 1)
        return refuse(ErrorCode::NOT_SUPPORTED,
                      "SamplesPerPixel is " + std::to_string(samplesPerPixel) + ", not 1");
    if (h.size.x < 1 || h.size.y < 1 || h.size.z < 1)
        return refuse(ErrorCode::VALUE_INVALID,
                      "Columns, Rows, NumberOfFrames are " + core::formatTriple(h.size));
    if (h.bitsAllocated != 8 && h.bitsAllocated != 16 && h.bitsAllocated != 32)
        return refuse(ErrorCode::NOT_SUPPORTED,
                      "BitsAllocated is " + std::to_string(h.bitsAllocated) + ", not 8, 16 or 32");
    if (h.bitsStored < 1 || h.highBit >= h.bitsAllocated || h.highBit + 1 < h.bitsStored)
        return refuse(ErrorCode::VALUE_INVALID, "BitsStored " + std::to_string(h.bitsStored) +
                                                    " and HighBit " + std::to_string(h.highBit) +
                                                    " do not fit " +
                                                    std::to_string(h.bitsAllocated) + " bits");
    if (h.slope == 0.0) return refuse(ErrorCode::VALUE_INVALID, "RescaleSlope is 0");
    return {};
}

Result<DicomHeader> interpret(const Values& values, const std::string& name)
{
    DicomHeader h;
    const double frames = values.decimal(NUMBER_OF_FRAMES, 1.0);
    h.size = {values.number(COLUMNS, 0), values.number(ROWS, 0),
              frames >= 1.0 && frames < 1e8 ? static_cast<int>(frames) : 0};
    h.bitsAllocated = values.number(BITS_ALLOCATED, 0);
    h.bitsStored = values.number(BITS_STORED, h.bitsAllocated);
    h.highBit = values.number(HIGH_BIT, h.bitsStored - 1);
    h.isSigned = values.number(PIXEL_REPRESENTATION, 0) != 0;
    h.slope = values.decimal(RESCALE_SLOPE, 1.0);
    h.intercept = values.decimal(RESCALE_INTERCEPT, 0.0);
    // Between rows comes first in the file.
    const std::vector<double> spacing = values.decimals(PIXEL_SPACING);
    if (spacing.size() == 2 && spacing[0] > 0.0 && spacing[1] > 0.0)
        h.pixelSpacing = {spacing[1], spacing[0]};
    h.sliceSpacing =
        std::fabs(values.decimal(SPACING_BETWEEN_SLICES, values.decimal(SLICE_THICKNESS, 0.0)));
    h.position = positionOf(values);
    h.axes = axesOf(values);
    h.series = values.text(SERIES);
    const double instance = values.decimal(INSTANCE_NUMBER, NAN);
    if (std::fabs(instance) < 1e15) h.instance = static_cast<std::int64_t>(instance);
    if (Status status = check(h, values.number(SAMPLES_PER_PIXEL, 1), name); !status.ok())
        return status;
    return h;
}

/// Finds the pixels, which are what the stream is at.
Result<DicomHeader> locatePixels(DicomHeader h, const Element& e, Elements& elements,
                                 const std::string& name)
{
    if (e.length == UNDEFINED_LENGTH)
        return Status(ErrorCode::NOT_SUPPORTED, name + ": the pixels are compressed");
    h.pixelOffset = elements.position();
    const std::int64_t needed = h.pixelBytes();
    const std::string need = " bytes of pixels, where " + core::formatTriple(h.size) +
                             " of them need " + std::to_string(needed);
    if (elements.left() < needed)
        return Status(ErrorCode::FILE_UNREADABLE,
                      name + " has " + std::to_string(elements.left()) + need);
    if (e.length < needed)
        return Status(ErrorCode::SIZE_MISMATCH,
                      name + " announces " + std::to_string(e.length) + need);
    return h;
}

/// How the rest of the file is written; empty for what can be read.
std::string unsupportedSyntax(const std::string& syntax, bool& implicit)
{
    implicit = syntax.empty() || syntax == "1.2.840.10008.1.2";
    if (implicit || syntax == "1.2.840.10008.1.2.1") return {};
    return "transfer syntax " + syntax.substr(0, 64) + " is compressed or big endian";
}

} // namespace

bool isDicom(std::istream& file)
{
    char head[132];
    file.clear();
    file.seekg(0);
    const bool found = file.read(head, sizeof(head)) && std::memcmp(head + 128, "DICM", 4) == 0;
    file.clear();
    return found;
}

Result<DicomHeader> readDicomHeader(std::istream& file, const std::string& name)
{
    if (!isDicom(file))
        return Status(ErrorCode::FILE_UNREADABLE, name + " does not start as a DICOM file does");
    Elements elements(file);
    Values values;
    bool inMeta = true;
    Element e;
    for (;;) {
        const std::int64_t start = elements.position();
        if (!elements.next(e)) break;
        if (inMeta && e.tag >> 16 != 2) {
            // The first element behind the meta group: from here on the transfer syntax holds.
            inMeta = false;
            bool implicit = false;
            const std::string unsupported =
                unsupportedSyntax(values.text(TRANSFER_SYNTAX), implicit);
            if (!unsupported.empty())
                return Status(ErrorCode::NOT_SUPPORTED, name + ": " + unsupported);
            if (implicit) elements.setImplicit();
            file.seekg(start);
            continue;
        }
        if (e.tag == PIXEL_DATA) {
            const Result<DicomHeader> header = interpret(values, name);
            return header.ok() ? locatePixels(*header, e, elements, name) : header;
        }
        const bool wanted = Values::wants(e.tag) && e.length <= MAXIMUM_VALUE;
        if (wanted ? !elements.value(e, values[e.tag]) : !elements.skip(e)) break;
    }
    return Status(ErrorCode::FILE_UNREADABLE, name + " ends, or is broken, before its pixels");
}

} // namespace io
} // namespace osgVolumizer
