#include <osgVolumizer/io/FileKind.h>
#include <osgVolumizer/io/PluginFile.h>

#include "../support/FolderTest.h"

namespace FileKindTest {

using namespace osgVolumizer;
using io::FileKind;
using io::fileKindOf;

namespace {

std::string at(std::size_t offset, const std::string& text)
{
    return std::string(offset, '\0') + text + std::string(16, '\0');
}

} // namespace

TEST(FileKind, IsToldFromTheBeginningWhateverTheName)
{
    const std::pair<std::string, FileKind> heads[] = {
        {at(128, "DICM"), FileKind::DICOM},
        {std::string("\2\0\0\0UL\4\0\x9c\0\0\0\0\0\0\0", 16), FileKind::DICOM},
        {std::string("\10\0\5\0CS\12\0ISO_IR 100", 18), FileKind::DICOM},
        {std::string("\0\10\0\5CS\0\12ISO_IR 100", 18), FileKind::DICOM},   // big endian
        {std::string("\10\0\5\0\12\0\0\0ISO_IR 100", 18), FileKind::DICOM}, // implicit
        {"NRRD0004\ntype: short\n", FileKind::MEDICAL},
        {at(344, std::string("n+1\0", 4)), FileKind::MEDICAL},
        {at(4, std::string("n+2\0\r\n\x1a\n", 8)), FileKind::MEDICAL},
        {"ObjectType = Image\nNDims = 3\n", FileKind::MEDICAL},
        {at(208, "MAP "), FileKind::MEDICAL},
        {"# vtk DataFile Version 3.0\n", FileKind::VTK},
        {"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", FileKind::VTK},
        {"<VTKFile type=\"ImageData\">", FileKind::VTK},
        {std::string(" BDV\0\0\0\0\xe0\0\0\0", 12), FileKind::OPENVDB},
        {"\x89HDF\r\n\x1a\n...", FileKind::HDF5},
        {"CDF\1....", FileKind::NETCDF},
        {"\x93NUMPY....", FileKind::NUMPY},
        {std::string("II*\0\10\0\0\0", 8), FileKind::IMAGE},
        {"nothing known", FileKind::IMAGE}};
    for (const auto& [head, kind] : heads)
        for (const char* name : {"scan", "scan.xyz", "a.b/IM0001"})
            EXPECT_EQ(kind, fileKindOf(head, name)) << head << " " << name;
}

TEST(FileKind, TheNameDecidesWhereTheBeginningSaysNothing)
{
    const std::pair<const char*, FileKind> names[] = {
        {"scan.h5", FileKind::HDF5},      {"a/SCAN.HDF5", FileKind::HDF5},
        {"c:/d.e/x.ims", FileKind::HDF5}, {"x.nii.gz", FileKind::MEDICAL},
        {"x.hdr", FileKind::MEDICAL},     {"x.vdb", FileKind::OPENVDB},
        {"x.nc", FileKind::NETCDF},       {"x.dcm", FileKind::DICOM},
        {"scan.tif", FileKind::IMAGE},    {"scan.h5.tif", FileKind::IMAGE},
        {"a.h5/scan", FileKind::IMAGE},   {"h5", FileKind::IMAGE},
        {".h5", FileKind::IMAGE},         {"", FileKind::IMAGE},
        {"scan_h5", FileKind::IMAGE},     {"x.raw", FileKind::IMAGE}};
    for (const auto& [name, kind] : names)
        EXPECT_EQ(kind, fileKindOf({}, name)) << name;
    EXPECT_EQ(FileKind::IMAGE, fileKindOf(std::string("II*\0\10\0\0\0", 8), "x.dcm"));
    // Both say something: NetCDF-4 is HDF5 inside, and Radiance has pictures of this name.
    EXPECT_EQ(FileKind::NETCDF, fileKindOf("\x89HDF\r\n\x1a\n...", "x.nc"));
    EXPECT_EQ(FileKind::IMAGE, fileKindOf("#?RADIANCE\n", "x.hdr"));
    EXPECT_EQ(FileKind::OPENVDB, fileKindOf(std::string(" BDV\0\0\0\0\xe0\0\0\0", 12), "x.tif"));
}

using FileKindOfFiles = support::FolderTest;

TEST_F(FileKindOfFiles, FoldersOfZarr)
{
    EXPECT_EQ(FileKind::IMAGE, fileKindOf(path("")));
    writeBytes(".zgroup", "{}");
    EXPECT_EQ(FileKind::ZARR, fileKindOf(path("")));
    EXPECT_EQ(FileKind::IMAGE, fileKindOf(path("none.h5/none"))); // no such file
}

TEST(FileKind, EveryPluginSaysWhatItNeeds)
{
    for (const FileKind kind :
         {FileKind::DICOM, FileKind::MEDICAL, FileKind::VTK, FileKind::OPENVDB, FileKind::HDF5,
          FileKind::NETCDF, FileKind::ZARR}) {
        const auto formats = io::pluginFormatsOf(kind);
        ASSERT_FALSE(formats.empty());
        for (const io::PluginFormat& format : formats)
            EXPECT_NE(std::string::npos, std::string(format.needs).find("Debian: "));
    }
    EXPECT_TRUE(io::pluginFormatsOf(FileKind::IMAGE).empty());
    EXPECT_TRUE(io::writersOf("a.tif").empty());
    EXPECT_FALSE(io::writersOf("a.nrrd").empty());
}

} // namespace FileKindTest
