// Images and rectilinear grids of VTK, against what was written to them.

#ifdef OSGVOLUMIZER_HAVE_VTK_IMAGES

#include "VtkFiles.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/io/Placement.h>

#include <osgDB/ReadFile>

#include <vtkBitArray.h>
#include <vtkCharArray.h>
#include <vtkLongLongArray.h>
#include <vtkShortArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkUnsignedLongLongArray.h>
#include <vtkUnsignedShortArray.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace VtkImageTest {

using namespace osgVolumizer;

namespace {

using VtkImage = VtkFolderTest;

std::vector<double> counted(int count, double first = 0.0)
{
    std::vector<double> values(static_cast<std::size_t>(count));
    std::iota(values.begin(), values.end(), first);
    return values;
}

void expectPlace(const VoxelSource& source, const glm::dvec3& voxel, const glm::dvec3& expected)
{
    const glm::dvec3 found = io::placeOf(source.describe(), voxel);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[axis], expected[axis], 1e-12) << axis;
}

std::string legacyImage(const std::string& data, const std::string& coding = "ASCII")
{
    return "# vtk DataFile Version 3.0\nof a test\n" + coding +
           "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 2\nORIGIN 10 20 30\nSPACING 1 2 0.5\n" +
           data;
}

std::string listed(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i)
        text += std::to_string(i) + (i % 9 == 8 ? "\n" : " ");
    return text + "\n";
}

std::string bigEndian(int count)
{
    std::string bytes;
    for (int i = 0; i < count; ++i) {
        bytes += static_cast<char>(i >> 8);
        bytes += static_cast<char>(i);
    }
    return bytes;
}

} // namespace

TEST_F(VtkImage, ValuesAndPlacesInEveryEncoding)
{
    const auto set = image(5, 4, 3);
    set->SetExtent(2, 6, -1, 2, 10, 12);
    set->SetOrigin(100.0, 200.0, 300.0);
    set->SetSpacing(0.5, 2.0, 3.0);
    // To the front, to the left, down: turned, and left-handed.
    const double direction[9] = {0.0, -1.0, 0.0, 0.8, 0.0, 0.6, -0.6, 0.0, 0.8};
    set->SetDirectionMatrix(direction);
    const std::vector<double> values = counted(60, -30.5);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    int number = 0;
    const auto check = [&](int mode, int compressor, bool encoded) {
        const std::string file =
            writeImage("a" + std::to_string(number++) + ".vti", set, mode, compressor, encoded);
        const Source source = open(file);
        ASSERT_TRUE(source) << file;
        const VoxelSource::Description d = source->describe();
        EXPECT_EQ(d.size, glm::ivec3(5, 4, 3));
        EXPECT_EQ(d.type, VoxelType::FLOAT32);
        EXPECT_EQ(valuesOf(source), values) << file;
        for (const glm::dvec3& v :
             {glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(1, 2, 2)}) {
            const glm::dvec3 s = (v + glm::dvec3(2, -1, 10)) * glm::dvec3(0.5, 2.0, 3.0);
            expectPlace(
                *source, v,
                {100.0 - s.y, 200.0 + 0.8 * s.x + 0.6 * s.z, 300.0 - 0.6 * s.x + 0.8 * s.z});
        }
    };
    for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
        for (const int compressor :
             {vtkXMLWriter::NONE, vtkXMLWriter::LZ4, vtkXMLWriter::ZLIB, vtkXMLWriter::LZMA})
            check(mode, compressor, true);
    check(vtkXMLWriter::Appended, vtkXMLWriter::NONE, false);
    check(vtkXMLWriter::Appended, vtkXMLWriter::ZLIB, false);
    EXPECT_EQ(number, 14);
    EXPECT_EQ(told(), "");
}

TEST_F(VtkImage, LegacyStructuredPoints)
{
    const std::string head = "POINT_DATA 24\nSCALARS a short 1\nLOOKUP_TABLE default\n";
    const std::string ascii = writeBytes("a.vtk", legacyImage(head + listed(24)));
    const std::string binary =
        writeBytes("b.vtk", legacyImage(head + bigEndian(24) + "\n", "BINARY"));
    // What the name says does not matter.
    const std::string unnamed = writeBytes("points", legacyImage(head + listed(24)));
    for (const std::string& file : {ascii, binary, unnamed}) {
        const Source source = open(file);
        ASSERT_TRUE(source);
        EXPECT_EQ(source->describe().size, glm::ivec3(4, 3, 2));
        EXPECT_EQ(source->describe().type, VoxelType::INT16);
        EXPECT_EQ(valuesOf(source), counted(24));
        expectPlace(*source, {0, 0, 0}, {10, 20, 30});
        expectPlace(*source, {3, 2, 1}, {13, 24, 30.5});
    }
}

TEST_F(VtkImage, HolesAndInfinityAreKept)
{
    const auto set = image(3, 2, 2);
    std::vector<double> values = counted(12);
    values[3] = NAN;
    values[4] = -INFINITY;
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    const Source source = open(writeImage("a.vti", set, vtkXMLWriter::Appended));
    ASSERT_TRUE(source);
    const std::vector<double> found = valuesOf(source);
    EXPECT_TRUE(std::isnan(found[3]));
    EXPECT_EQ(found[4], -INFINITY);
    EXPECT_EQ(found[5], 5.0);
}

TEST_F(VtkImage, EverySectionOfALegacyFileIsPassedOver)
{
    const std::string sections =
        "FIELD FieldData 2\nTIME 1 1 double\n3.5\nnote 1 1 string\nas%20it%20is\nPOINT_DATA 24\n"
        "SCALARS first%20one float\nLOOKUP_TABLE own\n" +
        listed(24) + "LOOKUP_TABLE own 2\n0 0 0 1\n1 1 1 1\nVECTORS v double\n" + listed(72) +
        "METADATA\nINFORMATION 0\n\nCOLOR_SCALARS paint 3\n" + listed(0);
    std::string paint;
    for (int i = 0; i < 72; ++i)
        paint += i % 3 == 1 ? "1.0 " : "0.0 ";
    const std::string rest = paint + "\nTEXTURE_COORDINATES t 2 float\n" + listed(48) +
                             "NORMALS n float\n" + listed(72) + "TENSORS m float\n" + listed(216) +
                             "FIELD more 2\nf 1 24 unsigned_char\n" + listed(24) + "g 2 24 int\n" +
                             listed(48) +
                             "CELL_DATA 6\nSCALARS f int\n"
                             "LOOKUP_TABLE default\n" +
                             listed(6);
    const std::string file = writeBytes("a.vtk", legacyImage(sections + rest));
    const auto entries = listVolumes(file);
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    std::string names;
    for (const VolumeEntry& e : *entries)
        names += e.name + ":" + std::to_string(e.channels) + (e.chosen ? "* " : " ");
    EXPECT_EQ(names, "first one:1* v:3 paint:3 t:2 n:3 m:9 f:1 g:2 cells:f:1 ");
    EXPECT_EQ((*entries)[6].text, "points, from 0 to 23");
    EXPECT_EQ((*entries)[6].type, VoxelType::UINT8);
    EXPECT_EQ((*entries)[8].text, "cells, from 0 to 5");
    EXPECT_EQ((*entries)[8].size, osg::Vec3i(3, 2, 1));
    EXPECT_EQ(valuesOf(open(file, "dataset='first one'")), counted(24));
    EXPECT_EQ(valuesOf(open(file, "dataset=g channel=1"))[5], 11.0);
    EXPECT_EQ(valuesOf(open(file, "dataset=m channel=8"))[23], 215.0);
    EXPECT_EQ(valuesOf(open(file, "dataset=cells:f")), counted(6));
    EXPECT_EQ(valuesOf(open(file, "dataset=points:f")), counted(24));
    EXPECT_EQ(valuesOf(open(file, "dataset=paint"))[7], std::round(255.0 * 0.7152));
}

TEST_F(VtkImage, CellsAreSamplesAtTheirMiddles)
{
    const auto set = image(4, 3, 1);
    set->SetOrigin(1.0, 2.0, 3.0);
    set->SetSpacing(2.0, 4.0, 0.0);
    addArray<vtkUnsignedCharArray>(set->GetCellData(), "c", 1, counted(6));
    const Source source = open(writeImage("a.vti", set));
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().size, glm::ivec3(3, 2, 1));
    EXPECT_EQ(valuesOf(source), counted(6));
    expectPlace(*source, {0, 0, 0}, {2.0, 4.0, 3.0});
    expectPlace(*source, {2, 1, 0}, {6.0, 8.0, 3.0});
}

TEST_F(VtkImage, ArraysAreChosenByName)
{
    const auto set = image(3, 2, 2);
    addArray<vtkFloatArray>(set->GetPointData(), "flow", 3, counted(36));
    addArray<vtkFloatArray>(set->GetPointData(), "b", 1, counted(12, 1.0));
    addArray<vtkFloatArray>(set->GetPointData(), "two words", 1, counted(12, 2.0));
    addArray<vtkFloatArray>(set->GetCellData(), "c", 1, counted(2, 3.0));
    // The first of one component, or what is active.
    EXPECT_EQ(valuesOf(open(writeImage("a.vti", set)))[0], 1.0);
    set->GetPointData()->SetActiveScalars("two words");
    const std::string file = writeImage("b.vti", set);
    EXPECT_EQ(valuesOf(open(file))[0], 2.0);
    EXPECT_EQ(valuesOf(open(file, "dataset=b"))[0], 1.0);
    EXPECT_EQ(valuesOf(open(file, "dataset=c"))[0], 3.0);
    EXPECT_EQ(valuesOf(open(file, "dataset=\"two words\""))[0], 2.0);
    EXPECT_NE(refusal(file, "dataset=d", ErrorCode::VALUE_INVALID)
                  .find("\"d\"; there are: flow, b, two words, c"),
              std::string::npos);
    const auto entries = listVolumes(file);
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    ASSERT_EQ(entries->size(), 4u);
    EXPECT_TRUE((*entries)[2].chosen);
    EXPECT_FALSE((*entries)[1].chosen);
    EXPECT_EQ((*entries)[0].channels, 3);
    EXPECT_EQ((*entries)[3].text, "cells, from 3 to 4");
    EXPECT_EQ((*entries)[3].size, osg::Vec3i(2, 1, 1));
    for (int i = 0; i < 12; ++i)
        addArray<vtkFloatArray>(set->GetPointData(), ("x" + std::to_string(i)).c_str(), 1,
                                counted(12));
    EXPECT_NE(refusal(writeImage("c.vti", set), "dataset=d", ErrorCode::VALUE_INVALID)
                  .find("x5, x6, ..."),
              std::string::npos);
    EXPECT_NE(refusal(writeImage("d.vti", image(2, 2, 2)), "", ErrorCode::VALUE_INVALID)
                  .find("no arrays"),
              std::string::npos);
}

TEST_F(VtkImage, ComponentsBecomeColoursLengthsOrOne)
{
    const auto set = image(2, 2, 1);
    addArray<vtkUnsignedCharArray>(set->GetPointData(), "rgb", 3,
                                   std::vector<int>{255, 0, 0, 9, 9, 9, 0, 255, 0, 0, 0, 255});
    addArray<vtkUnsignedCharArray>(set->GetPointData(), "rgba", 4, counted(16));
    addArray<vtkFloatArray>(set->GetPointData(), "v", 3,
                            std::vector<double>{3, 4, 0, 0, 0, 2, 2, 3, 6, 0, 0, 0});
    addArray<vtkShortArray>(set->GetPointData(), "s", 3, counted(12));
    const std::string file = writeImage("a.vti", set);
    const Source rgb = open(file, "dataset=rgb"), rgba = open(file, "dataset=rgba");
    ASSERT_TRUE(rgb && rgba);
    EXPECT_EQ(rgb->describe().components, 1);
    EXPECT_EQ(rgb->describe().type, VoxelType::UINT8);
    EXPECT_EQ(valuesOf(rgb), (std::vector<double>{54, 9, 182, 18}));
    EXPECT_EQ(rgba->describe().components, 4);
    EXPECT_EQ(valuesOf(rgba), counted(16));
    EXPECT_EQ(told(), "");
    EXPECT_EQ(valuesOf(open(file, "dataset=v")), (std::vector<double>{5, 2, 7, 0}));
    EXPECT_NE(told().find("\"v\" has 3 components, of which the length"), std::string::npos);
    forgetTold();
    EXPECT_EQ(valuesOf(open(file, "dataset=v channel=2")), (std::vector<double>{0, 2, 6, 0}));
    EXPECT_EQ(valuesOf(open(file, "dataset=rgba channel=3")), (std::vector<double>{3, 7, 11, 15}));
    EXPECT_EQ(told(), "");
    EXPECT_EQ(valuesOf(open(file, "dataset=s")), (std::vector<double>{0, 3, 6, 9}));
    EXPECT_NE(told().find("\"s\" has 3 components, of which the first"), std::string::npos);
    EXPECT_NE(refusal(file, "dataset=v channel=3", ErrorCode::INDEX_OUT_OF_RANGE)
                  .find("no channel 3, but 3, from 0 on"),
              std::string::npos);
}

TEST_F(VtkImage, WideTypesBecomeTheNarrowestThatHoldsThem)
{
    const auto set = image(2, 2, 1);
    const std::pair<std::vector<long long>, VoxelType> wide[] = {
        {{0, 1, 2, 255}, VoxelType::UINT8},           {{-1, 1, 2, 127}, VoxelType::INT8},
        {{0, 1, 2, 65535}, VoxelType::UINT16},        {{-1, 1, 2, 128}, VoxelType::INT16},
        {{0, 1, 2, 4294967295LL}, VoxelType::UINT32}, {{-1, 1, 2, 65536}, VoxelType::INT32},
        {{-1, 1, 2, 1LL << 50}, VoxelType::FLOAT64}};
    int number = 0;
    for (const auto& [values, type] : wide)
        addArray<vtkLongLongArray>(set->GetPointData(), std::to_string(number++).c_str(), 1,
                                   values);
    addArray<vtkBitArray>(set->GetPointData(), "bits", 1, std::vector<int>{1, 0, 1, 1});
    addArray<vtkUnsignedLongLongArray>(set->GetPointData(), "unsigned", 1, counted(4));
    const double fraction = 0.1, high = 1e12;
    addArray<vtkDoubleArray>(set->GetPointData(), "real", 1,
                             std::vector<double>{fraction, 1, 2, -1e30});
    addArray<vtkDoubleArray>(set->GetPointData(), "shifted", 1,
                             std::vector<double>{high + 0.25, high, high + 2, high + 3});
    addArray<vtkDoubleArray>(set->GetPointData(), "huge", 1, std::vector<double>{1e300, 1, 2, 3});
    const std::string file = writeImage("a.vti", set, vtkXMLWriter::Appended);
    number = 0;
    for (const auto& [values, type] : wide) {
        const Source source = open(file, "dataset=" + std::to_string(number++));
        ASSERT_TRUE(source);
        EXPECT_EQ(source->describe().type, type) << number;
        EXPECT_EQ(valuesOf(source), std::vector<double>(values.begin(), values.end()));
    }
    const Source bits = open(file, "dataset=bits"), real = open(file, "dataset=real"),
                 shifted = open(file, "dataset=shifted"), huge = open(file, "dataset=huge"),
                 plain = open(file, "dataset=unsigned");
    ASSERT_TRUE(bits && real && shifted && huge && plain);
    EXPECT_EQ(bits->describe().type, VoxelType::UINT8);
    EXPECT_EQ(valuesOf(bits), (std::vector<double>{1, 0, 1, 1}));
    EXPECT_EQ(plain->describe().type, VoxelType::UINT8);
    EXPECT_EQ(real->describe().type, VoxelType::FLOAT32);
    EXPECT_EQ(valuesOf(real)[0], double(float(fraction)));
    EXPECT_EQ(shifted->describe().type, VoxelType::FLOAT64);
    EXPECT_EQ(valuesOf(shifted)[0], high + 0.25);
    EXPECT_EQ(huge->describe().type, VoxelType::FLOAT64);
}

TEST_F(VtkImage, HiddenPointsAndCellsAreHoles)
{
    const auto set = image(4, 2, 2);
    addArray<vtkUnsignedCharArray>(set->GetPointData(), "a", 1, counted(16));
    addArray<vtkFloatArray>(set->GetCellData(), "c", 1, counted(3));
    addArray<vtkUnsignedCharArray>(set->GetPointData(), "rgba", 4, counted(64, 1.0));
    std::vector<int> cells{vtkDataSetAttributes::HIDDENCELL, vtkDataSetAttributes::HIDDENCELL,
                           vtkDataSetAttributes::DUPLICATECELL};
    addArray<vtkUnsignedCharArray>(set->GetCellData(), "vtkGhostType", 1, cells);
    std::vector<int> points(16, 0);
    points[7] = vtkDataSetAttributes::HIDDENPOINT;
    points[6] = vtkDataSetAttributes::DUPLICATEPOINT;
    addArray<vtkUnsignedCharArray>(set->GetPointData(), "vtkGhostType", 1, points);
    const std::string file = writeImage("a.vti", set);
    const Source a = open(file, "dataset=a"), c = open(file, "dataset=c"),
                 rgba = open(file, "dataset=rgba");
    ASSERT_TRUE(a && c && rgba);
    EXPECT_EQ(a->describe().type, VoxelType::FLOAT32);
    const std::vector<double> values = valuesOf(a), middles = valuesOf(c), colours = valuesOf(rgba);
    // Points of x 0 and 1 belong to hidden cells alone.
    for (std::size_t i = 0; i < 16; ++i) {
        const bool hidden = i % 4 < 2 || i == 7;
        EXPECT_EQ(std::isnan(values[i]), hidden) << i;
        if (!hidden) {
            EXPECT_EQ(values[i], double(i));
        }
        EXPECT_EQ(colours[4 * i + 3], hidden ? 0.0 : 4.0 * double(i) + 4.0) << i;
    }
    EXPECT_TRUE(std::isnan(middles[0]) && std::isnan(middles[1]));
    EXPECT_EQ(middles[2], 2.0);
    EXPECT_EQ(listVolumes(file)->size(), 3u); // the marks are none of them
}

TEST_F(VtkImage, PiecesOfAParallelFile)
{
    const auto piece = [this](const char* name, int low, int high) {
        const auto set = image(1, 1, 1);
        set->SetExtent(low, high, 0, 1, 0, 1);
        std::vector<double> values;
        for (int row = 0; row < 4; ++row)
            for (int x = low; x <= high; ++x)
                values.push_back(10 * row + x);
        addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
        return writeImage(name, set, vtkXMLWriter::Appended);
    };
    piece("left.vti", 0, 3);
    const std::string right = piece("right.vti", 3, 5);
    const std::string file = writeBytes(
        "all.pvti",
        "<?xml version=\"1.0\"?><VTKFile type=\"PImageData\" version=\"0.1\"><PImageData "
        "WholeExtent=\"0 5 0 1 0 1\" GhostLevel=\"0\" Origin=\"1 2 3\" Spacing=\"2 1 1\">"
        "<PPointData Scalars=\"a\"><PDataArray type=\"Float32\" Name=\"a\"/></PPointData>"
        "<Piece Extent=\"0 3 0 1 0 1\" Source=\"left.vti\"/>"
        "<Piece Extent=\"3 5 0 1 0 1\" Source=\"right.vti\"/></PImageData></VTKFile>");
    const Source source = open(file);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().size, glm::ivec3(6, 2, 2));
    const std::vector<double> values = valuesOf(source);
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_EQ(values[i], double(i / 6 * 10 + i % 6));
    expectPlace(*source, {5, 0, 0}, {11, 2, 3});
    const std::string whole = contentOf(right);
    testing::internal::CaptureStderr();
    writeBytes("right.vti", whole.substr(0, whole.size() / 2));
    refusal(file, "", ErrorCode::FILE_UNREADABLE);
    std::filesystem::remove(right);
    EXPECT_NE(refusal(file, "", ErrorCode::FILE_UNREADABLE).find("right.vti was not found"),
              std::string::npos);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Numbers of a digit, of which doubles made eight bytes.
TEST_F(VtkImage, ParallelFilesOfTextAndWhereTheyLie)
{
    const auto set = image(20, 20, 20);
    std::vector<double> values;
    for (int i = 0; i < 8000; ++i)
        values.push_back(i % 10);
    addArray<vtkDoubleArray>(set->GetPointData(), "a", 1, values);
    writeImage("text.vti", set, vtkXMLWriter::Ascii);
    const Source source = open(writeBytes(
        "all.pvti",
        "<?xml version=\"1.0\"?><VTKFile type=\"PImageData\" version=\"0.1\"><PImageData "
        "WholeExtent=\"0 19 0 19 0 19\" GhostLevel=\"0\" Origin=\"1 2 3\" Spacing=\"1 2 4\" "
        "Direction=\"0 -1 0 1 0 0 0 0 -1\"><PPointData Scalars=\"a\">"
        "<PDataArray type=\"Float64\" Name=\"a\"/></PPointData>"
        "<Piece Extent=\"0 19 0 19 0 19\" Source=\"text.vti\"/></PImageData></VTKFile>"));
    ASSERT_TRUE(source);
    EXPECT_EQ(valuesOf(source), values);
    expectPlace(*source, {0, 0, 0}, {1, 2, 3});
    expectPlace(*source, {10, 5, 2}, {-9, 12, -5});
}

TEST_F(VtkImage, FilesUnderTheirOwnNamesAreVolumes)
{
    const auto set = image(4, 4, 4);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, counted(64));
    addArray<vtkFloatArray>(set->GetPointData(), "two words", 1, counted(64, 5.0));
    writeImage("a.vti", set);
    std::string legacy =
        legacyImage("POINT_DATA 24\nSCALARS a short 1\nLOOKUP_TABLE default\n" + listed(24) +
                    "SCALARS two%20words short 1\n"
                    "LOOKUP_TABLE default\n" +
                    listed(24));
    writeBytes("a.vtk", legacy);
    const auto load = [this](const std::string& name, const std::string& options) {
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path(name), o);
        return osg::ref_ptr<VolumeAppearance>(dynamic_cast<VolumeAppearance*>(node.get()));
    };
    const auto image = load("a.vti", "dataset='two words' ray=maximum");
    ASSERT_TRUE(image && image->getVoxels());
    EXPECT_EQ(image->getVoxels()->getRange(), osg::Vec2d(5.0, 68.0));
    const auto points = load("a.vtk", "table=none-of-them unit=7 dataset='two words'");
    EXPECT_FALSE(points); // the table
    for (const std::string option : {"dataset", "scalars"}) {
        const auto said = load("a.vtk", "unit=7 " + option + "=\"two words\"");
        ASSERT_TRUE(said && said->getVoxels());
        EXPECT_EQ(said->getOpacityUnit(), 7.0);
        EXPECT_EQ(valuesOf(said->getVoxels()->getSource()), counted(24));
        EXPECT_EQ(said->getVoxels()->getFileName(), path("a.vtk"));
    }
    EXPECT_FALSE(load("a.vtk", "scalars=b"));
    EXPECT_FALSE(load("b.vti", ""));
}

} // namespace VtkImageTest

#endif
