#include "NiftiHeader.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr int INTENT_RGB = 2003, INTENT_RGBA = 2004;

/// Fields of a header, by their place in it.
class Fields
{
public:
    Fields(std::string_view head, bool swapped) : _head(head), _swapped(swapped) {}
    template <class T>
    T at(std::size_t offset) const
    {
        T value;
        std::memcpy(&value, _head.data() + offset, sizeof(T));
        if (_swapped) core::swapBytes(&value, sizeof(T), 1);
        return value;
    }

private:
    std::string_view _head;
    bool _swapped;
};

/// What both versions have, in the types of the second.
struct Common
{
    std::int64_t dim[8];
    int type, units, qformCode, sformCode, intent;
    double pixdim[8], slope, intercept, quatern[3], qoffset[3], srow[3][4], offset;
    bool nifti;
};

Common readFirst(const Fields& f, bool nifti)
{
    Common c = {};
    c.nifti = nifti;
    for (std::size_t i = 0; i < 8; ++i) {
        c.dim[i] = f.at<std::int16_t>(40 + 2 * i);
        c.pixdim[i] = f.at<float>(76 + 4 * i);
    }
    c.type = f.at<std::int16_t>(70);
    c.offset = f.at<float>(108);
    // Analyze has no such fields; SPM writes its scale there.
    c.slope = f.at<float>(112);
    c.intercept = f.at<float>(116);
    if (!nifti) return c;
    c.intent = f.at<std::int16_t>(68);
    c.units = f.at<std::uint8_t>(123);
    c.qformCode = f.at<std::int16_t>(252);
    c.sformCode = f.at<std::int16_t>(254);
    for (std::size_t i = 0; i < 3; ++i) {
        c.quatern[i] = f.at<float>(256 + 4 * i);
        c.qoffset[i] = f.at<float>(268 + 4 * i);
        for (std::size_t j = 0; j < 4; ++j)
            c.srow[i][j] = f.at<float>(280 + 16 * i + 4 * j);
    }
    return c;
}

Common readSecond(const Fields& f)
{
    Common c = {};
    c.nifti = true;
    for (std::size_t i = 0; i < 8; ++i) {
        c.dim[i] = f.at<std::int64_t>(16 + 8 * i);
        c.pixdim[i] = f.at<double>(104 + 8 * i);
    }
    c.type = f.at<std::int16_t>(12);
    c.offset = double(f.at<std::int64_t>(168));
    c.slope = f.at<double>(176);
    c.intercept = f.at<double>(184);
    c.qformCode = f.at<std::int32_t>(344);
    c.sformCode = f.at<std::int32_t>(348);
    for (std::size_t i = 0; i < 3; ++i) {
        c.quatern[i] = f.at<double>(352 + 8 * i);
        c.qoffset[i] = f.at<double>(376 + 8 * i);
        for (std::size_t j = 0; j < 4; ++j)
            c.srow[i][j] = f.at<double>(400 + 32 * i + 8 * j);
    }
    c.units = f.at<std::int32_t>(500);
    c.intent = f.at<std::int32_t>(504);
    return c;
}

Status refuseType(int type)
{
    return {ErrorCode::NOT_SUPPORTED,
            "has numbers of NIfTI's type " + std::to_string(type) + ", which no voxels are of"};
}

Status applyType(int type, Samples& s)
{
    struct Type
    {
        int code;
        Number number;
        int channels;
        bool colour;
    };
    constexpr Type TYPES[] = {{2, Number::UINT8, 1, false},      {4, Number::INT16, 1, false},
                              {8, Number::INT32, 1, false},      {16, Number::FLOAT32, 1, false},
                              {32, Number::FLOAT32, 2, false},   {64, Number::FLOAT64, 1, false},
                              {128, Number::UINT8, 3, true},     {256, Number::INT8, 1, false},
                              {512, Number::UINT16, 1, false},   {768, Number::UINT32, 1, false},
                              {1024, Number::INT64, 1, false},   {1280, Number::UINT64, 1, false},
                              {1792, Number::FLOAT64, 2, false}, {2304, Number::UINT8, 4, true}};
    const Type* found = std::find_if(std::begin(TYPES), std::end(TYPES),
                                     [type](const Type& t) { return t.code == type; });
    if (found == std::end(TYPES)) return refuseType(type);
    s.number = found->number;
    s.channels = found->channels;
    s.colour = found->colour;
    return {};
}

Status applySize(const Common& c, Samples& s)
{
    const std::int64_t count = c.dim[0];
    std::int64_t dim[8] = {0, 1, 1, 1, 1, 1, 1, 1};
    for (std::int64_t i = 1; i <= count; ++i) {
        dim[i] = c.dim[i];
        if (dim[i] < 1 || dim[i] > std::numeric_limits<int>::max())
            return {ErrorCode::VALUE_INVALID,
                    "has " + std::to_string(dim[i]) + " samples on axis " + std::to_string(i)};
    }
    const bool matrix = dim[6] > 1 || dim[7] > 1 || (dim[5] > 1 && s.channels > 1);
    if (matrix)
        return {ErrorCode::NOT_SUPPORTED, "has more than a vector for each sample, as matrices of "
                                          "connections do: it is no volume"};
    s.size = {int(dim[1]), int(dim[2]), int(dim[3])};
    s.steps = int(dim[4]);
    if (dim[5] == 1) return {};
    s.channels = int(dim[5]);
    s.planar = true;
    s.colour = (c.intent == INTENT_RGB && dim[5] == 3) || (c.intent == INTENT_RGBA && dim[5] == 4);
    return {};
}

double unitOf(int units)
{
    switch (units & 7) {
    case 1:
        return 1000.0; // m
    case 3:
        return 0.001; // micrometres
    default:
        return 1.0;
    }
}

// In RAS and the units of the file; a column each.
void fromQuaternion(const Common& c, const glm::dvec3& spacing, Samples& s)
{
    double b = c.quatern[0], cc = c.quatern[1], d = c.quatern[2];
    double a = 1.0 - (b * b + cc * cc + d * d);
    if (a < 1e-7) { // half a turn
        const double scale = 1.0 / std::sqrt(b * b + cc * cc + d * d);
        b *= scale;
        cc *= scale;
        d *= scale;
        a = 0.0;
    } else {
        a = std::sqrt(a);
    }
    const double z = c.pixdim[0] < 0.0 ? -spacing.z : spacing.z;
    s.axes[0] = spacing.x * glm::dvec3(a * a + b * b - cc * cc - d * d, 2.0 * (b * cc + a * d),
                                       2.0 * (b * d - a * cc));
    s.axes[1] = spacing.y * glm::dvec3(2.0 * (b * cc - a * d), a * a + cc * cc - b * b - d * d,
                                       2.0 * (cc * d + a * b));
    s.axes[2] = z * glm::dvec3(2.0 * (b * d + a * cc), 2.0 * (cc * d - a * b),
                               a * a + d * d - cc * cc - b * b);
    s.position = {c.qoffset[0], c.qoffset[1], c.qoffset[2]};
}

// Likewise. Whether the sform spans a volume; a single slice needs no third axis.
bool fromMatrix(const Common& c, const glm::dvec3& spacing, Samples& s)
{
    glm::dmat3 axes(0.0);
    glm::dvec3 position(0.0);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            axes[j][i] = c.srow[i][j];
        position[i] = c.srow[i][3];
    }
    const glm::dvec3 normal = glm::cross(axes[0], axes[1]);
    if (s.size.z == 1 && axes[2] == glm::dvec3(0.0) && glm::length(normal) > 0.0)
        axes[2] = spacing.z * glm::normalize(normal);
    const double volume = std::abs(glm::determinant(axes));
    if (!(volume > 0.0) || !std::isfinite(volume + glm::dot(position, position))) return false;
    s.axes = axes;
    s.position = position;
    return true;
}

void applyPlace(const Common& c, Samples& s)
{
    glm::dvec3 spacing(1.0);
    for (int i = 0; i < 3; ++i)
        if (const double v = std::abs(c.pixdim[i + 1]); v > 0.0 && std::isfinite(v)) spacing[i] = v;
    const bool placed = c.sformCode > 0 && fromMatrix(c, spacing, s);
    if (c.sformCode > 0 && !placed)
        s.note = std::string("its sform spans no volume, and so it lies where its ") +
                 (c.qformCode > 0 ? "qform" : "spacing") + " says";
    if (!placed && c.qformCode > 0) {
        fromQuaternion(c, spacing, s);
    } else if (!placed) {
        s.axes = glm::dmat3(-spacing.x, 0, 0, 0, spacing.y, 0, 0, 0, spacing.z);
        s.position = -0.5 * (s.axes * (glm::dvec3(s.size) - 1.0));
    }
    const double unit = unitOf(c.units);
    for (glm::dvec3* v : {&s.axes[0], &s.axes[1], &s.axes[2], &s.position})
        *v *= glm::dvec3(-unit, -unit, unit); // to LPS
}

} // namespace

Result<NiftiHeader> NiftiHeader::parse(std::string_view head)
{
    constexpr std::size_t FIRST = 348, SECOND = 540;
    const auto short_ = [] {
        return Status(ErrorCode::FILE_UNREADABLE, "is cut short within its header");
    };
    NiftiHeader header;
    if (head.size() < FIRST) return short_();
    std::int32_t length = 0;
    std::memcpy(&length, head.data(), 4);
    std::int32_t turned = length;
    core::swapBytes(&turned, 4, 1);
    header.swapped = turned == std::int32_t(FIRST) || turned == std::int32_t(SECOND);
    if (header.swapped) length = turned;
    if (length != std::int32_t(FIRST) && length != std::int32_t(SECOND))
        return Status(ErrorCode::FILE_UNREADABLE, "does not begin as NIfTI or Analyze files do");
    const bool second = length == std::int32_t(SECOND);
    if (second && head.size() < SECOND) return short_();
    const std::string_view magic = head.substr(second ? 4 : 344, 3);
    const bool nifti = second || magic == "n+1" || magic == "ni1";
    const Fields fields(head, header.swapped);
    const Common c = second ? readSecond(fields) : readFirst(fields, nifti);
    header.detached = magic.substr(0, 2) != "n+";
    if (c.dim[0] < 1 || c.dim[0] > 7)
        return Status(ErrorCode::VALUE_INVALID,
                      "has " + std::to_string(c.dim[0]) + " dimensions, where NIfTI has 1 to 7");
    if (!(c.offset >= 0.0 && c.offset < 9e15))
        return Status(ErrorCode::VALUE_INVALID, "has samples at a byte that no file has");
    header.offset = static_cast<std::int64_t>(c.offset);
    Status status = applyType(c.type, header.samples);
    if (status.ok()) status = applySize(c, header.samples);
    if (!status.ok()) return status;
    if (c.slope != 0.0 && std::isfinite(c.slope) && !header.samples.colour) {
        header.samples.slope = c.slope;
        header.samples.intercept = std::isfinite(c.intercept) ? c.intercept : 0.0;
    }
    applyPlace(c, header.samples);
    return header;
}

} // namespace medical
} // namespace osgVolumizer
