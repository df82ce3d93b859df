// Damaged volumes of VTK, and files that are none: refused in a sentence, and quietly.

#ifdef OSGVOLUMIZER_HAVE_VTK_IMAGES

#include "VtkFiles.h"

#include <vtkUnsignedShortArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <osgDB/ReadFile>

#include <vtkPoints.h>

#include <random>

namespace VtkBadImageTest {

using namespace osgVolumizer;

namespace {

class VtkBadImage : public VtkFolderTest
{
protected:
    /// A file of each coding: content, and what its name ends in.
    std::vector<std::pair<std::string, std::string>> goodFiles() const
    {
        const auto set = image(5, 4, 3);
        addArray<vtkUnsignedShortArray>(set->GetPointData(), "a", 1, std::vector<int>(60, 7));
        addArray<vtkUnsignedShortArray>(set->GetPointData(), "b", 1, std::vector<int>(60, 8));
        set->GetPointData()->SetActiveScalars("a");
        std::vector<std::pair<std::string, std::string>> files;
        const auto add = [&](const std::string& file, const char* ending) {
            files.emplace_back(contentOf(file), ending);
        };
        add(writeImage("1.vti", set), ".vti");
        add(writeImage("2.vti", set, vtkXMLWriter::Binary), ".vti");
        add(writeImage("3.vti", set, vtkXMLWriter::Appended, vtkXMLWriter::NONE, false), ".vti");
        add(writeImage("4.vti", set, vtkXMLWriter::Appended, vtkXMLWriter::ZLIB, false), ".vti");
        add(writeImage("5.vti", set, vtkXMLWriter::Appended, vtkXMLWriter::LZ4), ".vti");
        add(writeImage("6.vti", set, vtkXMLWriter::Binary, vtkXMLWriter::LZMA), ".vti");
        add(writeImage("8.vti", set, vtkXMLWriter::Appended), ".vti");
        const auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
        vtkNew<vtkDoubleArray> x;
        for (int i = 0; i < 4; ++i)
            x->InsertNextValue(i * i);
        grid->SetDimensions(4, 4, 4);
        grid->SetXCoordinates(x);
        grid->SetYCoordinates(x);
        grid->SetZCoordinates(x);
        addArray<vtkUnsignedShortArray>(grid->GetPointData(), "a", 1, std::vector<int>(64, 7));
        add(writeGrid("7.vtr", grid), ".vtr");
        std::string values, bytes;
        for (int i = 0; i < 60; ++i) {
            values += "7 ";
            bytes += std::string("\0\7", 2);
        }
        const std::string head = "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN 0 0 0\n"
                                 "SPACING 1 1 1\nPOINT_DATA 60\nSCALARS a unsigned_short 1\n"
                                 "LOOKUP_TABLE default\n";
        files.emplace_back("# vtk DataFile Version 3.0\nt\nASCII" + head + values, ".vtk");
        files.emplace_back("# vtk DataFile Version 3.0\nt\nBINARY" + head + bytes, ".vtk");
        return files;
    }

    static constexpr double VALUE = 7.0;
    /// Refused in a sentence, or whole.
    void expectWholeOrRefused(const std::string& name, const std::string& content,
                              const std::string& what)
    {
        const std::string file = writeBytes(name, content);
        const auto voxels = readVoxels(file);
        if (voxels.ok()) {
            const std::vector<double> values = valuesOf(*(*voxels)->getSource());
            for (const double v : values)
                if (v != VALUE) {
                    ADD_FAILURE() << what << " was read as " << v;
                    break;
                }
            return;
        }
        expectSentence(voxels.status, file, what);
    }
    static void expectSentence(const Status& status, const std::string& file,
                               const std::string& what)
    {
        EXPECT_EQ(status.text.rfind(file, 0), 0u) << what << ": " << status.text;
        EXPECT_EQ(status.text.find('\n'), std::string::npos) << what << ": " << status.text;
        EXPECT_GT(status.text.size(), file.size() + 10) << what;
    }
    static std::string withAll(std::string text, const std::string& from, const std::string& to)
    {
        for (std::size_t at = text.find(from); at != std::string::npos;
             at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
        return text;
    }
    static std::string with(std::string text, const std::string& from, const std::string& to)
    {
        const std::size_t found = text.find(from);
        EXPECT_NE(found, std::string::npos) << from;
        return found == std::string::npos ? text : text.replace(found, from.size(), to);
    }
};

} // namespace

TEST_F(VtkBadImage, FilesCutShort)
{
    testing::internal::CaptureStderr();
    int number = 0;
    for (const auto& [content, ending] : goodFiles()) {
        const std::string name = "cut" + ending;
        for (std::size_t size = 0; size < content.size(); size += size < 64 ? 7 : 23)
            expectWholeOrRefused(name, content.substr(0, size),
                                 std::to_string(size) + " bytes of file " + std::to_string(number));
        // Half of the data is never enough.
        EXPECT_FALSE(readVoxels(writeBytes(name, content.substr(0, content.size() * 2 / 3))).ok())
            << number;
        ASSERT_TRUE(readVoxels(writeBytes(name, content)).ok()) << number;
        ++number;
    }
    EXPECT_EQ(number, 10);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VtkBadImage, SizesThatTheFileCannotHold)
{
    const auto files = goodFiles();
    const std::string& ascii = files[0].first;
    const std::string& packed = files[3].first;
    const std::string& grid = files[7].first;
    const std::string& legacy = files[8].first;
    const std::string& binary = files[9].first;
    const std::string extent = "0 4 0 3 0 2", huge = "0 4000 0 3000 0 2000";
    const std::pair<std::string, std::string> bad[] = {
        {with(ascii, extent, huge), "24 of 24000000000 cells"},
        {withAll(ascii, extent, huge), "calls for"},
        {with(ascii, extent, "0 4 0 3 0 2147483646"), "no six numbers"},
        {with(ascii, extent, "0 4 0 3 2 0"), "no six numbers"},
        {with(ascii, extent, "0 4 0 3"), "no six numbers"},
        {with(ascii, extent, "0 4 0 3 0 99999999999999999999"), "no six numbers"},
        {with(ascii, "Piece Extent=\"" + extent, "Piece Extent=\"" + huge), "calls for"},
        {with(packed, "vtkZLibDataCompressor", "vtkOtherCompressor"), "not known"},
        {withAll(packed, extent, huge), "calls for"},
        {with(ascii, "Name=\"a\"", "NumberOfComponents=\"1000000000\" Name=\"a\""), "calls for"},
        {with(ascii, "Name=\"a\"", "NumberOfComponents=\"-1\" Name=\"a\""), "components"},
        {with(ascii, "UInt16", "Float128"), "not known"},
        {withAll(grid, "0 3 0 3 0 3", huge), "calls for"},
        {with(ascii, "type=\"ImageData\"", "type=\"PolyData\""), "no data set"},
        {with(legacy, "5 4 3", "5000 4000 3000"), "dimensions"},
        {with(legacy, "5 4 3", "5 4 -3"), "DIMENSIONS"},
        {with(legacy, "5 4 3", "5 4 4"), "is not of 80 values"},
        {with(legacy, "DIMENSIONS 5 4 3\n", ""), ""},
        {with(legacy, "unsigned_short 1", "unsigned_short 100000000"), "ends before"},
        {with(legacy, "unsigned_short 1", "unsigned_short 2"), "ends before"},
        {with(legacy, "unsigned_short 1", "quaternion 1"), "not known"},
        {with(legacy, "POINT_DATA 60", "POINT_DATA 61"), "is not of 60 values"},
        {with(binary, "unsigned_short 1", "double 1"), "ends before"},
        {legacy + "FIELD f 1\nx 1000000000 1000000000 double\n", "ends before"},
        {legacy + "LOOKUP_TABLE t 1000000000\n", "ends before"},
        {legacy + "WEIGHTS t 1\n", "not known"},
        {with(legacy, "7 7 7", "7 x 7"), "\"x\" stands where"},
        {with(legacy, "7 7 7", "7 7x 7"), "\"7x\" stands where"},
        {with(legacy, "7 7 7", "7 nan 7"), "\"nan\" stands where"}, // VTK reads none as text
        {"# vtk DataFile Version 3.0\n", "ASCII nor BINARY"}};
    testing::internal::CaptureStderr();
    for (const auto& [content, words] : bad) {
        const std::string file = writeBytes(content[0] == '#' ? "bad.vtk" : "bad.vti", content);
        EXPECT_NE(refusal(file, "", ErrorCode::FILE_UNREADABLE).find(words), std::string::npos)
            << refusal(file, "", ErrorCode::FILE_UNREADABLE);
        const auto entries = listVolumes(file);
        EXPECT_FALSE(entries.ok());
        expectSentence(entries.status, file, words);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Fewer numbers than the extent calls for, in files that are whole otherwise: VTK's readers would
// leave memory as it was.
TEST_F(VtkBadImage, ArraysOfTooFewNumbers)
{
    const auto files = goodFiles();
    testing::internal::CaptureStderr();
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].second != ".vti") continue;
        // A layer more, said by all or by the whole alone.
        const std::string more = withAll(files[i].first, "0 4 0 3 0 2", "0 4 0 3 0 3");
        const std::string text =
            refusal(writeBytes("more.vti", more), "", ErrorCode::FILE_UNREADABLE);
        EXPECT_NE(text.find("fewer than 80 numbers"), std::string::npos) << i << ": " << text;
        const std::string gap =
            with(files[i].first, "WholeExtent=\"0 4 0 3 0 2\"", "WholeExtent=\"0 4 0 3 0 3\"");
        EXPECT_NE(refusal(writeBytes("gap.vti", gap), "", ErrorCode::FILE_UNREADABLE)
                      .find("its pieces have 24 of 36 cells"),
                  std::string::npos);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// In base64 whatever is no letter of it ends the data.
TEST_F(VtkBadImage, LettersThatAreNone)
{
    const auto files = goodFiles();
    testing::internal::CaptureStderr();
    for (const std::size_t i : {1u, 6u}) { // inline and appended
        const std::string& good = files[i].first;
        const std::size_t start = i == 1 ? good.find('>', good.find("<DataArray")) + 20
                                         : good.find('_', good.find("<AppendedData")) + 1;
        for (const std::size_t at : {40u, 81u, 122u}) {
            std::string bad = good;
            bad[start + at] = '!';
            EXPECT_NE(refusal(writeBytes("bad.vti", bad), "", ErrorCode::FILE_UNREADABLE)
                          .find("fewer than 60 numbers"),
                      std::string::npos)
                << i << ", " << at;
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// A header of three numbers and the sizes of the blocks: as many as the file says are made room
// for.
TEST_F(VtkBadImage, CompressedBlocksThatDoNotAddUp)
{
    const std::string good = goodFiles()[3].first;
    const std::size_t start = good.find('_', good.find("<AppendedData")) + 1;
    ASSERT_LT(start + 12, good.size());
    const auto changed = [&](std::size_t word, std::uint32_t value) {
        std::string bytes = good;
        for (std::size_t i = 0; i < 4; ++i)
            bytes[start + 4 * word + i] = static_cast<char>(value >> 8 * i);
        return writeBytes("blocks.vti", bytes);
    };
    testing::internal::CaptureStderr();
    for (const auto& [word, value] : {std::pair<std::size_t, std::uint32_t>{0, 0xfffffff0u},
                                      {0, 0x10000000u},
                                      {0, 0},
                                      {1, 0xfffffff0u},
                                      {1, 10},
                                      {2, 0xfffffff0u}})
        EXPECT_NE(refusal(changed(word, value), "", ErrorCode::FILE_UNREADABLE)
                      .find("fewer than 60 numbers"),
                  std::string::npos)
            << word << ", " << value;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// VTK's readers take a block that cannot be unpacked for the end of the data.
TEST_F(VtkBadImage, BlocksThatCannotBeUnpacked)
{
    const auto set = image(20, 20, 20);
    std::vector<int> values(8000);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = int(i * i % 65536);
    addArray<vtkUnsignedShortArray>(set->GetPointData(), "a", 1, values);
    testing::internal::CaptureStderr();
    for (const int compressor : {vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA}) {
        vtkNew<vtkXMLImageDataWriter> writer;
        writer->SetFileName(path("a.vti").c_str());
        writer->SetInputData(set);
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        writer->SetCompressorType(compressor);
        writer->SetBlockSize(2000); // eight
        ASSERT_TRUE(writer->Write());
        const Source whole = open(path("a.vti"));
        ASSERT_TRUE(whole);
        EXPECT_EQ(valuesOf(whole), std::vector<double>(values.begin(), values.end()));
        std::string bytes = contentOf(path("a.vti"));
        const std::size_t start = bytes.find('_', bytes.find("<AppendedData")) + 1;
        const std::size_t middle = start + (bytes.rfind("</AppendedData>") - start) / 2;
        for (std::size_t i = 0; i < 400; ++i)
            bytes[middle + i] = '\xff';
        refusal(writeBytes("bad.vti", bytes), "", ErrorCode::FILE_UNREADABLE);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(VtkBadImage, PiecesThatAreNone)
{
    const auto parallel = [](const std::string& pieces) {
        return "<?xml version=\"1.0\"?><VTKFile type=\"PImageData\" version=\"0.1\"><PImageData "
               "WholeExtent=\"0 4 0 3 0 2\"><PPointData Scalars=\"a\"><PDataArray type=\"UInt16\" "
               "Name=\"a\"/></PPointData>" +
               pieces + "</PImageData></VTKFile>";
    };
    writeBytes("piece.vti", goodFiles()[0].first);
    const std::pair<std::string, std::string> bad[] = {
        {"", "0 of 24 cells"},
        {"<Piece Extent=\"0 4 0 3 0 2\" Source=\"all.pvti\"/>", "has pieces itself"},
        {"<Piece Extent=\"0 4 0 3 0 2\" Source=\"none.vti\"/>", "none.vti was not found"},
        {"<Piece Extent=\"0 4 0 3 0 2\"/>", "no regular file"},
        {"<Piece Extent=\"0 4 0 3 0 1\" Source=\"piece.vti\"/>", "12 of 24 cells"},
        {"<Piece Extent=\"0 4 0 3 0 3\" Source=\"piece.vti\"/>", "smaller than it says"},
        {"<Piece Extent=\"0 4\" Source=\"piece.vti\"/>", "the extent of a piece"}};
    for (const auto& [pieces, words] : bad)
        EXPECT_NE(refusal(writeBytes("all.pvti", parallel(pieces)), "", ErrorCode::FILE_UNREADABLE)
                      .find(words),
                  std::string::npos)
            << refusal(path("all.pvti"), "", ErrorCode::FILE_UNREADABLE);
    EXPECT_EQ(
        valuesOf(open(writeBytes(
            "all.pvti", parallel("<Piece Extent=\"0 4 0 3 0 2\" Source=\"piece.vti\"/>"))))[59],
        VALUE);
}

// Bytes changed anywhere: it must not end the process, nor print; values may differ.
TEST_F(VtkBadImage, BytesChangedAtRandom)
{
    std::mt19937 random(15);
    int refused = 0;
    testing::internal::CaptureStderr();
    for (const auto& [content, ending] : goodFiles())
        for (int i = 0; i < 40; ++i) {
            std::string changed = content;
            for (int k = 0; k < 1 + i % 3; ++k)
                changed[random() % changed.size()] = static_cast<char>(random());
            const std::string file = writeBytes("changed" + ending, changed);
            const auto voxels = readVoxels(file);
            if (voxels.ok()) continue;
            ++refused;
            expectSentence(voxels.status, file, std::to_string(i));
        }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(refused, 40);
}

TEST_F(VtkBadImage, DataSetsThatAreNoVolumes)
{
    const std::string head = "# vtk DataFile Version 3.0\na\nASCII\nDATASET ";
    const std::string grid =
        writeBytes("grid.vtk", head + "UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 0\n");
    const std::string faces = writeBytes("faces.vtk", head + "POLYDATA\nPOINTS 1 float\n0 0 0\n");
    EXPECT_NE(
        refusal(grid, "", ErrorCode::NOT_SUPPORTED).find("open the file itself, without .volume"),
        std::string::npos);
    EXPECT_NE(refusal(faces, "", ErrorCode::NOT_SUPPORTED).find("\"POLYDATA\""), std::string::npos);
    osgDB::ReaderWriter::ReadResult result =
        osgDB::Registry::instance()->readNode(grid + ".volume", nullptr);
    EXPECT_FALSE(result.getNode());
    EXPECT_NE(result.message().find("without .volume"), std::string::npos) << result.message();
    vtkNew<vtkUnstructuredGrid> cells;
    vtkNew<vtkPoints> points;
    points->InsertNextPoint(0, 0, 0);
    cells->SetPoints(points);
    EXPECT_NE(refusal(write<vtkXMLUnstructuredGridWriter>("a.vtu", cells.GetPointer()), "",
                      ErrorCode::NOT_SUPPORTED)
                  .find("without .volume"),
              std::string::npos);
}

} // namespace VtkBadImageTest

#endif
