#include "WriteFile.h"

#include "NiftiFields.h"
#include "Sink.h"

#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/io/PartFile.h>
#include <osgVolumizer/io/Placement.h>

#include <osgDB/FileNameUtils>

#include <filesystem>
#include <optional>

namespace osgVolumizer {
namespace medical {

namespace {

using Description = VoxelSource::Description;

bool isBigEndian()
{
    const std::uint16_t one = 1;
    return *reinterpret_cast<const unsigned char*>(&one) == 0;
}

std::string numbers(const glm::dvec3& v, const char* between)
{
    return core::formatNumber(v.x) + between + core::formatNumber(v.y) + between +
           core::formatNumber(v.z);
}

std::string sizes(const Description& d)
{
    return std::to_string(d.size.x) + ' ' + std::to_string(d.size.y) + ' ' +
           std::to_string(d.size.z);
}

/// `data`: the name of the file of samples; empty where they follow.
std::string nrrdHeader(const Description& d, const std::string& data)
{
    const VoxelType type = writtenType(d);
    const std::string name = type == VoxelType::FLOAT32   ? "float"
                             : type == VoxelType::FLOAT64 ? "double"
                                                          : voxelTypeName(type);
    const bool rgba = d.components == 4;
    std::string text = "NRRD0005\ntype: " + name + "\ndimension: " + (rgba ? "4" : "3") +
                       "\nspace: left-posterior-superior\nsizes: " + (rgba ? "4 " : "") + sizes(d) +
                       "\nspace directions:" + (rgba ? " none" : "");
    for (int i = 0; i < 3; ++i)
        text += " (" + numbers(d.axes[i] * d.spacing[i], ",") + ')';
    text += std::string("\nkinds:") + (rgba ? " RGBA-color" : "") +
            " domain domain domain\nendian: " + (isBigEndian() ? "big" : "little") +
            "\nencoding: raw\nspace units: \"mm\" \"mm\" \"mm\"\nspace origin: (" +
            numbers(io::placeOf(d, glm::dvec3(0.0)), ",") + ")\n";
    if (!data.empty()) text += "data file: " + data + '\n';
    return text + (data.empty() ? "\n" : "");
}

std::string metaType(VoxelType type)
{
    switch (type) {
    case VoxelType::INT8:
        return "MET_CHAR";
    case VoxelType::INT16:
        return "MET_SHORT";
    case VoxelType::UINT16:
        return "MET_USHORT";
    case VoxelType::INT32:
        return "MET_INT";
    case VoxelType::UINT32:
        return "MET_UINT";
    case VoxelType::FLOAT64:
        return "MET_DOUBLE";
    case VoxelType::UINT8:
        return "MET_UCHAR";
    default:
        return "MET_FLOAT";
    }
}

std::string metaHeader(const Description& d, const std::string& data)
{
    return std::string("ObjectType = Image\nNDims = 3\n") +
           (d.components == 4 ? "Comment = RGBA\n" : "") + "BinaryData = True\n" +
           "BinaryDataByteOrderMSB = " + (isBigEndian() ? "True" : "False") +
           "\nCompressedData = False\nTransformMatrix = " + numbers(d.axes[0], " ") + ' ' +
           numbers(d.axes[1], " ") + ' ' + numbers(d.axes[2], " ") +
           "\nOffset = " + numbers(io::placeOf(d, glm::dvec3(0.0)), " ") +
           "\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\nElementSpacing = " +
           numbers(d.spacing, " ") + "\nDimSize = " + sizes(d) +
           (d.components == 4 ? "\nElementNumberOfChannels = 4" : "") +
           "\nElementType = " + metaType(writtenType(d)) +
           "\nElementDataFile = " + (data.empty() ? "LOCAL" : data) + '\n';
}

Status failed(const std::string& path)
{
    return {ErrorCode::FILE_UNREADABLE, path + " cannot be written: is there room, and may it be?"};
}

// A header, and samples behind it or in a file of their own.
Status writeParts(const VoxelSource& source, const std::string& path, const std::string& header,
                  const std::string& dataPath, bool packed, bool planar)
{
    io::PartFile part(path);
    std::optional<io::PartFile> data;
    if (!dataPath.empty()) data.emplace(dataPath);
    {
        Sink head(part.name(), packed);
        head.write(header);
        std::optional<Sink> samples;
        if (data) samples.emplace(data->name(), false);
        Sink& into = data ? *samples : head;
        if (Status status = writeSamples(into, source, planar); !status.ok())
            return {status.code, path + ": " + status.text};
        if (data && !samples->close()) return failed(dataPath);
        if (!head.close()) return failed(path);
    }
    if (data)
        if (Status status = data->keep(); !status.ok()) return status;
    return part.keep();
}

// What is there without its header is not one of ours.
Status requireOwnData(const std::string& path, const std::string& data)
{
    std::error_code ignored;
    if (std::filesystem::exists(data, ignored) && !std::filesystem::exists(path, ignored))
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be written: its samples belong into " +
                                                data + ", which is there already"};
    return core::requireRegularTarget(data);
}

bool hasEnd(const std::string& name, const std::string& end)
{
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

} // namespace

Status writeFile(const VoxelSource& source, const std::string& path)
{
    const Description d = source.describe();
    if (Status status = d.validate(); !status.ok()) return status;
    if (Status status = core::requireRegularTarget(path); !status.ok()) return status;
    const std::string name = osgDB::convertToLowerCase(path);
    const bool detached = hasEnd(name, ".nhdr") || hasEnd(name, ".mhd");
    // Not STEM.raw, which can be somebody's.
    const std::filesystem::path data =
        detached ? std::filesystem::path(path + ".raw") : std::filesystem::path();
    const std::string dataName = data.filename().string();
    if (detached)
        if (Status status = requireOwnData(path, data.string()); !status.ok()) return status;
    if (hasEnd(name, ".nrrd") || hasEnd(name, ".nhdr"))
        return writeParts(source, path, nrrdHeader(d, dataName), data.string(), false, false);
    if (hasEnd(name, ".mha") || hasEnd(name, ".mhd"))
        return writeParts(source, path, metaHeader(d, dataName), data.string(), false, false);
    if (hasEnd(name, ".nii") || hasEnd(name, ".nii.gz")) {
        const bool planar = d.components == 4 && writtenType(d) != VoxelType::UINT8;
        return writeParts(source, path, niftiHeaderOf(d), "", hasEnd(name, ".gz"), planar);
    }
    return {ErrorCode::NOT_SUPPORTED, path + " is of a format that is only read"};
}

} // namespace medical
} // namespace osgVolumizer
