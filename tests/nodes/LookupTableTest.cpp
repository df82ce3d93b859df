#include <osgVolumizer/LookupTable.h>

#include <gtest/gtest.h>
#include <osgDB/Options>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

namespace LookupTableTest {

using namespace osgVolumizer;

namespace {

std::string temporary(const std::string& name)
{
    return (std::filesystem::path(testing::TempDir()) / ("osgVolumizerLookupTable_" + name))
        .string();
}

std::string write(const std::string& name, const std::string& text)
{
    std::ofstream(temporary(name), std::ios::binary) << text;
    return temporary(name);
}

std::string parseError(const std::string& text)
{
    const Result<LookupPoints> points = parseLookupTable(text, "bone.lut");
    EXPECT_FALSE(points.ok()) << text;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, points.status.code);
    EXPECT_EQ(0u, points.status.text.find("bone.lut")) << points.status.text;
    return points.status.text;
}

} // namespace

TEST(LookupTable, DefaultIsARampOverTheRange)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    EXPECT_EQ(glm::dvec4(0.25), table->getFunction()->evaluate(0.25));
    EXPECT_EQ(LookupTable::RANGE_FRACTION, table->getDomain());
}

TEST(LookupTable, Ramp)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const unsigned count = table->getModifiedCount();
    ASSERT_TRUE(table->setRamp(0.5, 0.2, osg::Vec3(1, 0.5, 0), 0.8).ok());
    EXPECT_GT(table->getModifiedCount(), count);
    const auto f = table->getFunction();
    EXPECT_EQ(glm::dvec4(0.0), f->evaluate(0.39));
    EXPECT_NEAR(0.4, f->evaluate(0.5).a, 1e-12);
    EXPECT_NEAR(0.25, f->evaluate(0.5).g, 1e-12);
    EXPECT_EQ(0.8, f->evaluate(0.7).a);
    ASSERT_TRUE(table->setRamp(0.5, -0.2).ok());
    EXPECT_EQ(1.0, table->getFunction()->evaluate(0.3).a);
    EXPECT_EQ(0.0, table->getFunction()->evaluate(0.7).a);
    ASSERT_TRUE(table->setRamp(0.5, 0.0).ok());
    EXPECT_EQ(0.0, table->getFunction()->evaluate(std::nextafter(0.5, 0.0)).a);
    EXPECT_EQ(1.0, table->getFunction()->evaluate(0.5).a);
}

TEST(LookupTable, RefusedChangesKeepTheOldTable)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const auto before = table->getFunction();
    const unsigned count = table->getModifiedCount();
    EXPECT_EQ(ErrorCode::VALUE_INVALID, table->setRamp(NAN, 0.1).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, table->setRamp(0.5, 0.1, osg::Vec3(2, 0, 0)).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, table->setRamp(0.5, 0.1, osg::Vec3(1, 1, 1), -0.5).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, table->setEntries({}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID,
              table->setEntries({osg::Vec4(0, 0, 0, 0), osg::Vec4(0, 0, 0, NAN)}).code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID,
              table->setPoints({{0.0, glm::dvec4(0)}}, static_cast<LookupTable::Domain>(5)).code);
    EXPECT_EQ(before, table->getFunction());
    EXPECT_EQ(count, table->getModifiedCount());
}

TEST(LookupTable, DataValuesAreNormalisedByTheRange)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    ASSERT_TRUE(table
                    ->setPoints({{-1000.0, glm::dvec4(0.0)}, {1000.0, glm::dvec4(1.0)}},
                                LookupTable::DATA_VALUES)
                    .ok());
    const auto f = table->getNormalizedFunction(osg::Vec2d(0.0, 2000.0));
    EXPECT_NEAR(0.5, f->evaluate(0.0).a, 1e-12);
    EXPECT_NEAR(1.0, f->evaluate(0.5).a, 1e-12);
    // Fractions are what they are.
    ASSERT_TRUE(table->setRamp(0.5, 1.0).ok());
    EXPECT_EQ(table->getFunction(), table->getNormalizedFunction(osg::Vec2d(0.0, 2000.0)));
}

TEST(LookupTable, ChangesWhileOthersRead)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const unsigned before = table->getModifiedCount();
    std::thread writer([&] {
        for (int i = 0; i < 500; ++i)
            table->setRamp(0.5, 0.1 + i * 0.001);
    });
    for (int i = 0; i < 500; ++i) {
        const auto f = table->getNormalizedFunction(osg::Vec2d(0.0, 1.0));
        EXPECT_NEAR(0.5, f->evaluate(0.5).a, 1e-12);
    }
    writer.join();
    EXPECT_EQ(before + 500u, table->getModifiedCount());
}

TEST(LookupTableFile, Parses)
{
    const Result<LookupPoints> points = parseLookupTable("\xEF\xBB\xBF# bone\r\n"
                                                         "-1000  0 0 0 0\r\n"
                                                         "\n"
                                                         "+2e2\t1 .5 0.25 1 # end",
                                                         "bone.lut");
    ASSERT_TRUE(points.ok()) << points.status.text;
    ASSERT_EQ(2u, points->size());
    EXPECT_EQ(-1000.0, (*points)[0].value);
    EXPECT_EQ(200.0, (*points)[1].value);
    EXPECT_EQ(glm::dvec4(1, 0.5, 0.25, 1), (*points)[1].color);
}

TEST(LookupTableFile, ErrorsNameFileLineFieldAndValue)
{
    EXPECT_EQ("bone.lut, line 2: opacity \"1.5\" is outside [0, 1]",
              parseError("0 0 0 0 0\n1 1 1 1 1.5\n"));
    EXPECT_EQ("bone.lut, line 1: green \"x\" is not a finite number", parseError("0 0 x 0 0"));
    EXPECT_EQ("bone.lut, line 1: value \"nan\" is not a finite number", parseError("nan 0 0 0 0"));
    EXPECT_EQ("bone.lut, line 1: red \"1e999\" is not a finite number",
              parseError("0 1e999 0 0 0"));
    EXPECT_EQ("bone.lut, line 3: value \"4\" is below that of the line before, 5",
              parseError("\n5 0 0 0 0\n4 0 0 0 0"));
    EXPECT_NE(std::string::npos, parseError("1 2 3").find("has 3 words"));
    EXPECT_NE(std::string::npos, parseError("# nothing\n").find("no line"));
    EXPECT_NE(std::string::npos, parseError("").find("no line"));
    EXPECT_LT(parseError(std::string(100000, '7') + "x 0 0 0 0").size(), 200u);
}

TEST(LookupTableFile, OsgTransferFunctions)
{
    const Result<LookupPoints> points =
        parseTransferFunctionFile("20 0 255 0 127.5 green\n10 0 0 0 0\n", "a.tf");
    ASSERT_TRUE(points.ok()) << points.status.text;
    EXPECT_EQ(10.0, (*points)[0].value);
    EXPECT_EQ(glm::dvec4(0, 1, 0, 0.5), (*points)[1].color);
    const Result<LookupPoints> scaled =
        parseTransferFunctionFile("colour-scale 1\n0 0 0 0 0\n1 1 1 1 0.25\n", "a.tf");
    ASSERT_TRUE(scaled.ok());
    EXPECT_EQ(0.25, (*scaled)[1].color.a);
    EXPECT_EQ("a.tf, line 1: colour scale \"0\" is not a positive number",
              parseTransferFunctionFile("colour-scale 0\n", "a.tf").status.text);
    EXPECT_EQ("a.tf, line 1: blue \"256\" is outside [0, 255]",
              parseTransferFunctionFile("0 0 0 256 0", "a.tf").status.text);
}

TEST(LookupTableFile, FilesRoundTrip)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    ASSERT_TRUE(table
                    ->setPoints({{-3.7e-5, {0.1, 0.2, 1.0 / 3.0, 0.0}}, {1e6, {1, 0, 0, 0.7}}},
                                LookupTable::DATA_VALUES)
                    .ok());
    const std::string path = temporary("round.lut");
    ASSERT_TRUE(writeLookupTable(*table, path).ok());
    const auto back = readLookupTable(path);
    ASSERT_TRUE(back.ok()) << back.status.text;
    EXPECT_EQ(LookupTable::DATA_VALUES, (*back)->getDomain());
    EXPECT_EQ(path, (*back)->getFileName());
    const auto& a = table->getFunction()->points();
    const auto& b = (*back)->getFunction()->points();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].value, b[i].value);
        EXPECT_EQ(a[i].color, b[i].color);
    }
}

TEST(LookupTableFile, AFractionTableIsWrittenForItsRange)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const std::string path = temporary("fraction.lut");
    ASSERT_TRUE(writeLookupTable(*table, path, osg::Vec2d(-100.0, 300.0)).ok());
    const auto back = readLookupTable(path);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(-100.0, (*back)->getFunction()->points().front().value);
    EXPECT_EQ(300.0, (*back)->getFunction()->points().back().value);
}

TEST(LookupTableFile, FoundAlongTheOptionsPath)
{
    write("path.lut", "0 0 0 0 0\n1 1 1 1 1\n");
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(testing::TempDir());
    EXPECT_TRUE(readLookupTable("osgVolumizerLookupTable_path.lut", options.get()).ok());
    const std::string tf = write("osg.tf", "0 0 0 0 0\n255 255 255 255 255\n");
    EXPECT_TRUE(readLookupTable(tf).ok());
}

TEST(LookupTableFile, MissingAndUnwritable)
{
    const auto missing = readLookupTable("no_such.lut");
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, missing.status.code);
    EXPECT_NE(std::string::npos, missing.status.text.find("no_such.lut"));
    EXPECT_FALSE(readLookupTable(testing::TempDir()).ok());
    osg::ref_ptr<LookupTable> table = new LookupTable;
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, writeLookupTable(*table, "/no_such_folder/a.lut").code);
}

TEST(LookupTableFile, TablesOfOthersAreCalledByTheirName)
{
    std::string imageJ(768, '\0');
    for (std::size_t i = 0; i < 256; ++i)
        imageJ[i] = static_cast<char>(i);
    const struct
    {
        const char* name;
        std::string text;
        const char* called;
    } cases[] = {
        {"p.json",
         "[\n{\n\"ColorSpace\": \"RGB\", \"Name\": \"X\",\n\"RGBPoints\": [0, 0, 0, 0, 1, 1, 1, "
         "1]\n}\n]",
         "ParaView colour map (JSON)"},
        {"p.xml",
         "<ColorMaps>\n<ColorMap name=\"a\"><Point x=\"0\" o=\"1\" r=\"0\" g=\"0\" "
         "b=\"0\"/></ColorMap>",
         "ParaView colour map (XML)"},
        {"s.vp",
         "1\n1\n0.2\n1\n0\n10 -3024 0 -86.9767 0 45.3791 0.169643 139.919 0.589286 347.907 "
         "0.607143\n",
         "3D Slicer"},
        {"s.vp.json", "{\"@schema\": \"x\", \"volumeProperties\": []}", "3D Slicer (JSON)"},
        {"s.ctbl", "# Color table file /tmp/a.ctbl\n# 2 values\n0 background 0 0 0 0\n",
         "colour table of 3D Slicer"},
        {"l.txt",
         "# ITK-SnAP Label Description File\n    1  255    0    0        1  1  1    \"Label 1\"\n",
         "ITK-SNAP"},
        {"a.am", "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\ndefine Lattice 256\n", "Amira"},
        {"i.lut", imageJ, "ImageJ"},
        {"s.lut",
         "1\n1\n0.1\n0.9\n0.2\n10\n12 -3024 0 143.556 0 166.222 0.686275 214.389 0.696078 "
         "419.736 0.833333 3071 0.803922\n4 0 1 255 1\n",
         "volume property of 3D Slicer"},
        {"f.txt", "#No. Label Name:   R   G   B   A\n\n0   Unknown   0   0   0   0\n",
         "FreeSurfer"},
        {"h.lut", "Index\tRed\tGreen\tBlue\n0\t0\t0\t0\n1\t1\t1\t1\n", "ImageJ (text)"},
        {"n.lut", "ICOL" + std::string(796, '\1'), "ImageJ"},
        {"a.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16), "image (PNG)"},
        {"a.jpg", std::string("\xff\xd8\xff\xe0\0\x10JFIF", 10), "image (JPEG)"},
        {"a.tif", std::string("II*\0\x08\0\0\0", 8), "image (TIFF)"},
        {"a.lut.gz", std::string("\x1f\x8b\x08\0\0\0\0\0", 8), "gzip"},
        {"b.lut", std::string("0 1\0 2\n", 7), "no text"},
        {"j.lut", "{}", "JSON"},
        {"x.lut", "\xEF\xBB\xBF<a/>", "XML"},
    };
    for (const auto& c : cases) {
        const auto table = readLookupTable(write(c.name, c.text));
        ASSERT_FALSE(table.ok()) << c.name;
        EXPECT_EQ(ErrorCode::NOT_SUPPORTED, table.status.code) << c.name;
        EXPECT_NE(std::string::npos, table.status.text.find(c.called)) << table.status.text;
        EXPECT_NE(std::string::npos, table.status.text.find(c.name)) << table.status.text;
        EXPECT_NE(std::string::npos, table.status.text.find(".lut")) << table.status.text;
    }
    // What is nobody's keeps the message of what is wrong in it.
    for (const char* text : {"0 1 2\n", "1\n1\n0.1\n0.9\n0.2\n", "Index\n0 1 2\n", "BM\n"}) {
        const auto bad = readLookupTable(write("bad.lut", text));
        EXPECT_EQ(ErrorCode::VALUE_INVALID, bad.status.code) << text;
        EXPECT_NE(std::string::npos, bad.status.text.find("line 1")) << bad.status.text;
    }
    // Nor is a table that can be read refused for what its comments say.
    EXPECT_TRUE(readLookupTable(write("own.lut", "# Color table file\n0 1 1 1 0\n")).ok());
}

} // namespace LookupTableTest
