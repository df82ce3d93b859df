// Cells of grids that are not shown, or ought not to be.

#if defined(OSGVOLUMIZER_HAVE_VTK) && defined(OSGVOLUMIZER_HAVE_VTK_IMAGES)

#include "VtkFiles.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/geometry/TetraMesh.h>

#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <cmath>

namespace VtkLeftOutTest {

using namespace osgVolumizer;

namespace {

/// Files of cells on the eight corners of a cube, its centre (8), and the first corner again (9).
class VtkLeftOut : public VtkFolderTest
{
protected:
    static constexpr int POINTS = 10;

    struct Cells
    {
        std::string connectivity, offsets, types, faces, faceOffsets;
        int count = 0, end = 0;

        Cells& add(int type, const std::string& points)
        {
            std::istringstream numbers(points);
            for (int n = 0; numbers >> n;)
                ++end;
            connectivity += points + " ";
            offsets += std::to_string(end) + " ";
            types += std::to_string(type) + " ";
            ++count;
            return *this;
        }
    };
    static std::string array(const std::string& type, const std::string& name,
                             const std::string& values, const std::string& attributes = {})
    {
        return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" " + attributes +
               " format=\"ascii\">" + values + "</DataArray>";
    }
    static std::string pointArray(const std::string& values = "0 1 2 3 4 5 6 7 8 9")
    {
        return "<PointData>" + array("Float64", "a", values) + "</PointData>";
    }
    static std::string xml(const Cells& c, const std::string& data = pointArray())
    {
        const std::string faces =
            c.faceOffsets.empty()
                ? std::string()
                : array("Int64", "faces", c.faces) + array("Int64", "faceoffsets", c.faceOffsets);
        return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"1.0\">"
               "<UnstructuredGrid><Piece NumberOfPoints=\"" +
               std::to_string(POINTS) + "\" NumberOfCells=\"" + std::to_string(c.count) + "\">" +
               data + "<Points>" +
               array("Float64", "p",
                     "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 0.5 0.5 0.5 0 0 0",
                     "NumberOfComponents=\"3\"") +
               "</Points><Cells>" + array("Int64", "connectivity", c.connectivity) +
               array("Int64", "offsets", c.offsets) + array("UInt8", "types", c.types) + faces +
               "</Cells></Piece></UnstructuredGrid></VTKFile>";
    }
    osg::ref_ptr<VolumeGeometry> load(const std::string& content, const std::string& options = {},
                                      const std::string& name = "a.vtu")
    {
        writeBytes(name, content);
        forgetTold();
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        o->setObjectCacheHint(osgDB::Options::CACHE_NONE);
        auto result = osgDB::Registry::instance()->readNode(path(name), o);
        _error = result.message();
        auto* appearance = dynamic_cast<VolumeAppearance*>(result.getNode());
        return appearance ? dynamic_cast<VolumeGeometry*>(appearance->getChild(0)) : nullptr;
    }
    void expectRefused(const std::string& content, const std::string& words,
                       const std::string& name = "a.vtu")
    {
        EXPECT_FALSE(load(content, {}, name)) << words;
        EXPECT_NE(_error.find(words), std::string::npos) << words << ": " << _error;
        EXPECT_NE(_error.find(name), std::string::npos) << _error;
        EXPECT_EQ(_error.find('\n'), std::string::npos) << _error;
    }
    static double volumeOf(const osg::ref_ptr<VolumeGeometry>& geometry)
    {
        return geometry ? core::volume(*geometry->getTetraSet()) : -1.0;
    }
    const std::string& error() const { return _error; }

    static Cells cube() { return Cells().add(12, "0 1 2 3 4 5 6 7"); }

private:
    std::string _error;
};

// The cube, as a polyhedron.
const std::string CUBE = "6  4 0 3 2 1  4 4 5 6 7  4 0 1 5 4  4 1 2 6 5  4 2 3 7 6  4 3 0 4 7";
constexpr int CUBE_NUMBERS = 31;

} // namespace

TEST_F(VtkLeftOut, CellsAreCountedByTheirReasons)
{
    Cells cells;
    cells.add(10, "0 1 3 4").add(1, "0").add(3, "0 1").add(5, "0 1 2").add(22, "0 1 2 3 4 5");
    cells.add(10, "0 1 2 3").add(12, "0 1 2 3 0 1 2 3").add(10, "5 5 6 7").add(10, "2 1 6 9");
    cells.add(200, "0 1 2").add(74, "0 1 2 3 4").add(0, "");
    const auto volume = load(xml(cells, pointArray("0 1 2 3 4 5 6 7 8 nan ")));
    ASSERT_TRUE(volume) << error();
    EXPECT_NEAR(volumeOf(volume), 1.0 / 6.0, 1e-15);
    // Of what is shown: the other points may hold anything.
    EXPECT_EQ(volume->getScalarRange(), osg::Vec2d(0.0, 4.0));
    EXPECT_EQ((*volume->getScalars())[4], 4.0f);
    EXPECT_TRUE(std::isnan((*volume->getScalars())[8]));
    EXPECT_NE(told().find("a.vtu: cells left out: 5 points, lines or faces, 2 without a volume, "
                          "1 of repeated points, 1 of values not finite, 2 of unknown kinds"),
              std::string::npos)
        << told();
    EXPECT_EQ(std::count(told().begin(), told().end(), '\n'), 1) << told();
}

TEST_F(VtkLeftOut, NothingIsToldWhereNothingIsLeftOut)
{
    EXPECT_NEAR(volumeOf(load(xml(cube()))), 1.0, 1e-15);
    EXPECT_EQ(told(), "");
}

// Wedges and tetrahedra are often hexahedra of repeated points.
TEST_F(VtkLeftOut, CollapsedCellsKeepTheirVolume)
{
    EXPECT_NEAR(volumeOf(load(xml(Cells().add(12, "0 1 2 2 4 5 6 6")))), 0.5, 1e-15);
    EXPECT_NEAR(volumeOf(load(xml(Cells().add(12, "0 1 2 2 4 4 4 4")))), 1.0 / 6.0, 1e-15);
    EXPECT_NEAR(volumeOf(load(xml(Cells().add(13, "0 1 3 4 4 4")))), 1.0 / 6.0, 1e-15);
    EXPECT_EQ(told(), "");
}

TEST_F(VtkLeftOut, ValuesThatAreNotFinite)
{
    Cells cells = Cells().add(10, "0 1 3 4").add(10, "1 2 3 6").add(10, "1 4 5 6");
    for (const char* bad : {"nan", "1e39", "-1e39"}) {
        const std::string values = std::string("5 ") + bad + " 7";
        const auto volume =
            load(xml(cells, "<CellData>" + array("Float64", "c", values) + "</CellData>"));
        ASSERT_TRUE(volume && volume->getScalars()) << bad << error();
        EXPECT_EQ(*volume->getScalars(), (std::vector<float>{5.0f, 7.0f}));
        EXPECT_NE(told().find("left out: 1 of values not finite"), std::string::npos) << told();
    }
    expectRefused(xml(cube(), pointArray("0 1 2 nan 4 5 6 7 8 9")),
                  "there are no cells to show, but 1 of values not finite");
}

TEST_F(VtkLeftOut, CellsAndPointsThatAreHidden)
{
    const Cells cells = Cells().add(10, "0 1 3 4").add(10, "1 2 3 6").add(10, "1 4 5 6");
    const auto marks = [](const std::string& values) {
        return array("UInt8", "vtkGhostType", values);
    };
    const std::string points = array("Float64", "a", "0 1 2 3 4 5 6 7 8 9");
    auto volume = load(xml(cells, "<PointData>" + points + "</PointData><CellData>" +
                                      marks("0 32 1") + "</CellData>"));
    ASSERT_TRUE(volume) << error();
    EXPECT_EQ(volume->getTetraSet()->tetraCount(), 2u); // a duplicate is shown
    EXPECT_NE(told().find("left out: 1 marked as hidden"), std::string::npos) << told();
    volume =
        load(xml(cells, "<PointData>" + points + marks("2 0 0 0 0 0 0 0 0 0") + "</PointData>"));
    ASSERT_TRUE(volume) << error();
    EXPECT_EQ(volume->getTetraSet()->tetraCount(), 2u);
    EXPECT_EQ(volume->getName(), "a");
}

TEST_F(VtkLeftOut, ComponentsAreChosenAsThoseOfImages)
{
    std::string vectors;
    for (int i = 0; i < POINTS; ++i)
        vectors += std::to_string(3 * i) + " 0 " + std::to_string(-4 * i) + " ";
    const std::string file =
        xml(cube(), "<PointData>" + array("Float32", "v", vectors, "NumberOfComponents=\"3\"") +
                        "</PointData>");
    const auto scalarOf = [this, &file](const std::string& options) {
        const auto volume = load(file, options);
        return volume && volume->getScalars() ? (*volume->getScalars())[7] : NAN;
    };
    EXPECT_EQ(scalarOf(""), 35.0f);
    EXPECT_NE(told().find("array \"v\" has 3 components, of which the length is shown"),
              std::string::npos)
        << told();
    EXPECT_EQ(scalarOf("channel=2"), -28.0f);
    EXPECT_EQ(told(), "");
    EXPECT_TRUE(std::isnan(scalarOf("channel=3")));
    EXPECT_NE(error().find("no channel 3, but 3"), std::string::npos) << error();
    EXPECT_TRUE(std::isnan(scalarOf("channel=-1")));
    const std::string colors = array("UInt8", "c", "1 2 3", "NumberOfComponents=\"3\"");
    expectRefused(xml(cube(), "<CellData>" + colors + "</CellData>"), "colours of cells");
}

TEST_F(VtkLeftOut, BadIndicesAreRefused)
{
    expectRefused(xml(Cells().add(12, "0 1 2 3 4 5 6 10")), "cell 0 refers to point 10 of 10");
    expectRefused(xml(cube().add(24, "0 1 2 3 4 5 6 7 8 -1")), "cell 1 refers to point -1");
    expectRefused(xml(cube().add(25, "0 1 2 3 4 5 6 7")), "cell 1 has 8 points");
    expectRefused(xml(Cells().add(72, "0 1 2 3 4 5 6 7 8")), "cell 0 has 9 points");
    expectRefused(xml(Cells().add(71, "0 1 2")), "cell 0 has 3 points");
    expectRefused(xml(Cells().add(41, "0 1 2")), "cell 0 has 3 points");
    expectRefused(xml(Cells()), "there are no cells to show");
    expectRefused(xml(cube(), ""), "there are no arrays of numbers");
    expectRefused(xml(cube(), pointArray("0 1 2")), "");
    std::string huge = xml(cube());
    huge.replace(huge.find("NumberOfPoints=\"10\""), 19, "NumberOfPoints=\"90000000000000\"");
    expectRefused(huge, "less in the file");
    huge = xml(cube());
    huge.replace(huge.find("NumberOfCells=\"1\""), 17, "NumberOfCells=\"90000000000000\"");
    expectRefused(huge, "less in the file");
}

// VTK's readers walk over faces as far as these say that they reach.
TEST_F(VtkLeftOut, FacesOfPolyhedraEndWhereTheyShould)
{
    const auto polyhedron = [](const std::string& faces, int numbers) {
        Cells cells = Cells().add(42, "0 1 2 3 4 5 6 7");
        cells.faces = faces;
        cells.faceOffsets = std::to_string(numbers);
        return xml(cells);
    };
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_NEAR(volumeOf(load(polyhedron(CUBE, CUBE_NUMBERS))), 1.0, 1e-15) << error();
    const std::string words = "faces";
    expectRefused(polyhedron(replaced(CUBE, "6 ", "7 "), CUBE_NUMBERS), words);
    expectRefused(polyhedron(replaced(CUBE, "6 ", "99999999999 "), CUBE_NUMBERS), words);
    expectRefused(polyhedron(replaced(CUBE, "6 ", "-1 "), CUBE_NUMBERS), words);
    expectRefused(polyhedron(replaced(CUBE, "4 0", "99999999999 0"), CUBE_NUMBERS), words);
    expectRefused(polyhedron(replaced(CUBE, "4 0", "-5 0"), CUBE_NUMBERS), words);
    expectRefused(polyhedron(replaced(CUBE, "3 2 1", "3 2 77"), CUBE_NUMBERS), "faces of cell 0");
    expectRefused(polyhedron(CUBE, CUBE_NUMBERS + 1), words);
    expectRefused(polyhedron(CUBE, CUBE_NUMBERS - 1), words);
    expectRefused(polyhedron(CUBE, 0), words);
    expectRefused(xml(Cells().add(42, "0 1 2 3 4 5 6 7")), words);
}

TEST_F(VtkLeftOut, FacesOfLegacyPolyhedraEndWhereTheyShould)
{
    const std::string head = "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                             "POINTS 8 double\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n";
    const std::string tail = "\nCELL_TYPES 1\n42\nPOINT_DATA 8\nSCALARS a double 1\n"
                             "LOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n";
    const std::string newHead = "# vtk DataFile Version 5.1" + head.substr(26);
    const auto newCells = [](const std::string& faces, int count) {
        return "CELLS 2 " + std::to_string(count) + "\nOFFSETS vtktypeint64\n0 " +
               std::to_string(count) + "\nCONNECTIVITY vtktypeint64\n" + faces;
    };
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_NEAR(volumeOf(load(head + "CELLS 1 32\n31 " + CUBE + tail, {}, "a.vtk")), 1.0, 1e-15)
        << error();
    EXPECT_NEAR(volumeOf(load(newHead + newCells(CUBE, 31) + tail, {}, "a.vtk")), 1.0, 1e-15)
        << error();
    for (const auto& [from, to] : {std::pair("6 ", "7 "),
                                   {"6 ", "99999999 "},
                                   {"6 ", "5 "},
                                   {"6 ", "-1 "},
                                   {"4 0", "9999 0"},
                                   {"4 0", "-5 0"},
                                   {"4 3 0", "5 3 0"}}) {
        const std::string bad = replaced(CUBE, from, to);
        expectRefused(head + "CELLS 1 32\n31 " + bad + tail, "do not end with cell 0", "a.vtk");
        expectRefused(head + "cells 1 32\n31 " + bad + tail, "do not end with cell 0", "a.vtk");
        expectRefused(newHead + newCells(bad, 31) + tail, "do not end with cell 0", "a.vtk");
    }
    const std::string good = newHead + newCells(CUBE, 31) + tail;
    expectRefused(head + newCells(CUBE, 31) + tail, "not what the file's version has", "a.vtk");
    expectRefused(replaced(good, "\n0 31", "\n98 31"), "no offset 0 of 2", "a.vtk");
    expectRefused(replaced(good, "\n0 31", "\n031"), "no offset 0 of 2", "a.vtk");
    expectRefused(replaced(good, "\n0 31", "\n0 30"), "offsets up to 30 of 31", "a.vtk");
}

} // namespace VtkLeftOutTest

#endif
