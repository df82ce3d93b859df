#include "FileKind.h"

#include "../core/RegularFile.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

namespace osgVolumizer {
namespace io {

namespace {

using namespace std::string_view_literals;

struct Ending
{
    std::string_view text; ///< in lower case
    FileKind kind;
};
constexpr Ending ENDINGS[] = {
    {".h5", FileKind::HDF5},         {".hdf5", FileKind::HDF5},      {".he5", FileKind::HDF5},
    {".ims", FileKind::HDF5},        {".nc", FileKind::NETCDF},      {".nc4", FileKind::NETCDF},
    {".cdf", FileKind::NETCDF},      {".zarr", FileKind::ZARR},      {".npy", FileKind::NUMPY},
    {".dcm", FileKind::DICOM},       {".dicom", FileKind::DICOM},    {".ima", FileKind::DICOM},
    {".nii", FileKind::MEDICAL},     {".nii.gz", FileKind::MEDICAL}, {".nia", FileKind::MEDICAL},
    {".hdr", FileKind::MEDICAL},     {".img", FileKind::MEDICAL},    {".img.gz", FileKind::MEDICAL},
    {".nrrd", FileKind::MEDICAL},    {".nhdr", FileKind::MEDICAL},   {".mha", FileKind::MEDICAL},
    {".mhd", FileKind::MEDICAL},     {".mrc", FileKind::MEDICAL},    {".rec", FileKind::MEDICAL},
    {".pic", FileKind::MEDICAL},     {".mnc", FileKind::MEDICAL},    {".mgh", FileKind::MEDICAL},
    {".mgz", FileKind::MEDICAL},     {".mgh.gz", FileKind::MEDICAL}, {".gipl", FileKind::MEDICAL},
    {".gipl.gz", FileKind::MEDICAL}, {".vtk", FileKind::VTK},        {".vti", FileKind::VTK},
    {".vtr", FileKind::VTK},         {".vdb", FileKind::OPENVDB}};

struct Magic
{
    std::size_t offset;
    std::string_view bytes;
    FileKind kind;
};
constexpr Magic MAGICS[] = {{128, "DICM"sv, FileKind::DICOM},
                            {0, "\x93NUMPY"sv, FileKind::NUMPY},
                            {0, "\x89HDF\r\n\x1a\n"sv, FileKind::HDF5},
                            {512, "\x89HDF\r\n\x1a\n"sv, FileKind::HDF5}, // behind a user block
                            {0, "CDF\1"sv, FileKind::NETCDF},
                            {0, "CDF\2"sv, FileKind::NETCDF},
                            {0, "CDF\5"sv, FileKind::NETCDF},
                            {0, " BDV\0\0\0\0"sv, FileKind::OPENVDB},
                            {0, "NRRD000"sv, FileKind::MEDICAL},
                            {344, "n+1\0"sv, FileKind::MEDICAL}, // NIfTI-1
                            {344, "ni1\0"sv, FileKind::MEDICAL},
                            {4, "n+2\0\r\n\x1a\n"sv, FileKind::MEDICAL}, // NIfTI-2
                            {4, "ni2\0\r\n\x1a\n"sv, FileKind::MEDICAL},
                            {208, "MAP "sv, FileKind::MEDICAL}, // MRC
                            {0, "# vtk DataFile"sv, FileKind::VTK}};

bool startsWith(std::string_view text, std::string_view start)
{
    return text.substr(0, start.size()) == start;
}

// DICOM without the 128 bytes and the word in front: an element of group 2 or 8, a known one, whose
// length is small, in either byte order.
bool isBareDicom(std::string_view head)
{
    if (head.size() < 16) return false;
    const auto byte = [&head](std::size_t i) {
        return static_cast<unsigned>(static_cast<unsigned char>(head[i]));
    };
    const bool big = byte(0) == 0;
    const unsigned group = big ? byte(1) : byte(0) | byte(1) << 8;
    const unsigned element = big ? byte(2) << 8 | byte(3) : byte(2) | byte(3) << 8;
    if ((group != 2 && group != 8) || element > 0x20) return false;
    const bool isExplicit = std::isupper(static_cast<unsigned char>(head[4])) &&
                            std::isupper(static_cast<unsigned char>(head[5]));
    return isExplicit || (!big && byte(5) == 0 && byte(6) == 0 && byte(7) == 0);
}

// Fields of MetaImage are lines of "Name = value"; the first says one of these.
bool isMetaImage(std::string_view head)
{
    for (const std::string_view field : {"ObjectType"sv, "NDims"sv, "Comment"sv})
        if (startsWith(head, field))
            return head.find("NDims") != std::string_view::npos &&
                   head.find('=') != std::string_view::npos;
    return false;
}

bool isVtkXml(std::string_view head)
{
    return startsWith(head, "<?xml") || startsWith(head, "<VTKFile")
               ? head.find("<VTKFile") != std::string_view::npos
               : false;
}

} // namespace

FileKind fileKindOf(std::string_view head, const std::string& path)
{
    const std::string name = osgDB::convertToLowerCase(osgDB::getSimpleFileName(path));
    const auto ending = std::find_if(std::begin(ENDINGS), std::end(ENDINGS), [&](const Ending& e) {
        return name.size() > e.text.size() &&
               std::string_view(name).substr(name.size() - e.text.size()) == e.text;
    });
    const FileKind byName = ending == std::end(ENDINGS) ? FileKind::IMAGE : ending->kind;
    for (const Magic& magic : MAGICS) {
        if (head.size() <= magic.offset || !startsWith(head.substr(magic.offset), magic.bytes))
            continue;
        // NetCDF-4 and MINC 2 are HDF5 inside.
        const bool nested = byName == FileKind::NETCDF || byName == FileKind::MEDICAL;
        return magic.kind == FileKind::HDF5 && nested ? byName : magic.kind;
    }
    if (isBareDicom(head)) return FileKind::DICOM;
    if (isMetaImage(head)) return FileKind::MEDICAL;
    if (isVtkXml(head)) return FileKind::VTK;
    // OpenImageIO has formats of these names, too: Radiance pictures, Softimage PIC, ...
    for (const std::string_view picture :
         {"#?RADIANCE"sv, "#?RGBE"sv, "\x53\x80\xf6\x34"sv, "II*\0"sv, "MM\0*"sv, "II+\0"sv,
          "MM\0+"sv, "\x89PNG"sv, "\xff\xd8\xff"sv, "\x76\x2f\x31\x01"sv})
        if (startsWith(head, picture)) return FileKind::IMAGE;
    return byName;
}

FileKind fileKindOf(const std::string& path)
{
    namespace fs = std::filesystem;
    std::error_code unknown;
    if (fs::is_directory(path, unknown)) {
        for (const char* name : {".zgroup", ".zarray", ".zattrs", "zarr.json"})
            if (fs::is_regular_file(fs::path(path) / name, unknown)) return FileKind::ZARR;
        return FileKind::IMAGE;
    }
    char head[1024];
    std::streamsize count = 0;
    if (!core::requireRegularFile(path).ok()) return FileKind::IMAGE;
    if (std::ifstream file(path, std::ios::binary); file) {
        file.read(head, sizeof(head));
        count = file.gcount();
    }
    return fileKindOf({head, static_cast<std::size_t>(count)}, path);
}

} // namespace io
} // namespace osgVolumizer
