// Unstructured grids, as VTK writes them and as nobody should.

#ifdef OSGVOLUMIZER_HAVE_VTK

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/geometry/TetraMesh.h>

#include <support/GLTest.h>
#include <support/Watchdog.h>

#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

namespace VtkReaderTest {

using namespace osgVolumizer;

namespace {

// A wedge on a pyramid on a hexahedron, a voxel beside it that shares a face, a tetrahedron
// beside that, and a triangle, which counts for nothing. Of volume 1 + 1/3 + 1/2 + 1 + 1/6 where
// the wedge stands free.
const std::string POINTS = "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1  0.5 0.5 2  "
                           "2 0 0  2 1 0  2 0 1  2 1 1  3 0 0  "
                           "5 0 0  6 0 0  5 1 0  5 0 1  6 0 1  5 1 1";
constexpr int POINT_COUNT = 20;
const std::string CELLS[] = {"0 1 2 3 4 5 6 7",    "4 5 6 7 8",  "14 15 16 17 18 19",
                             "1 9 2 10 5 11 6 12", "9 13 10 11", "0 1 2"};
const int TYPES[] = {12, 14, 13, 11, 10, 5};
const double VOLUME = 1.0 + 1.0 / 3.0 + 0.5 + 1.0 + 1.0 / 6.0;

std::string cellCount(const std::string& cell)
{
    return std::to_string(1 + std::count(cell.begin(), cell.end(), ' '));
}

std::string scalars(int components = 1)
{
    std::string r;
    for (int i = 0; i < POINT_COUNT * components; ++i)
        r += std::to_string(components == 1 ? 10 * i : i % 2) + " ";
    return r;
}

std::string legacy(const std::string& data)
{
    std::string r = "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                    std::to_string(POINT_COUNT) + " double\n" + POINTS + "\nCELLS 6 40\n";
    for (const std::string& c : CELLS)
        r += cellCount(c) + " " + c + "\n";
    r += "CELL_TYPES 6\n";
    for (const int t : TYPES)
        r += std::to_string(t) + "\n";
    return r + "POINT_DATA " + std::to_string(POINT_COUNT) + "\n" + data;
}

std::string legacyScalars()
{
    return legacy("SCALARS temperature double 1\nLOOKUP_TABLE default\n" + scalars() + "\n");
}

std::string xml()
{
    std::string connectivity, offsets, types;
    int offset = 0;
    for (int i = 0; i < 6; ++i) {
        connectivity += CELLS[i] + " ";
        offset += std::stoi(cellCount(CELLS[i]));
        offsets += std::to_string(offset) + " ";
        types += std::to_string(TYPES[i]) + " ";
    }
    const auto array = [](const std::string& type, const std::string& attributes,
                          const std::string& values) {
        return "<DataArray type=\"" + type + "\" " + attributes + " format=\"ascii\">" + values +
               "</DataArray>";
    };
    return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\">"
           "<UnstructuredGrid><Piece NumberOfPoints=\"" +
           std::to_string(POINT_COUNT) + "\" NumberOfCells=\"6\"><PointData Scalars=\"a\">" +
           array("Float64", "Name=\"a\"", scalars()) + array("Float64", "Name=\"b\"", scalars()) +
           "</PointData><Points>" + array("Float64", "NumberOfComponents=\"3\"", POINTS) +
           "</Points><Cells>" + array("Int64", "Name=\"connectivity\"", connectivity) +
           array("Int64", "Name=\"offsets\"", offsets) + array("UInt8", "Name=\"types\"", types) +
           "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

struct Read
{
    osg::ref_ptr<VolumeAppearance> appearance;
    const VolumeGeometry* volume = nullptr;
    const core::TetraSet* set = nullptr;
    std::string error;
};

// A folder of this process: tests run side by side.
std::string folder()
{
    const std::string name = ::testing::TempDir() + "/VtkReader" + std::to_string(getpid());
    std::filesystem::create_directories(name);
    return name;
}

Read read(const std::string& content, const std::string& extension, const std::string& options = "")
{
    const std::string path = folder() + "/VtkReaderTest." + extension;
    std::ofstream(path, std::ios::binary) << content;
    osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
    osgDB::ReaderWriter::ReadResult result = osgDB::Registry::instance()->readNode(path, o.get());
    Read r;
    r.appearance = dynamic_cast<VolumeAppearance*>(result.getNode());
    r.error = result.message();
    if (r.appearance) r.volume = dynamic_cast<VolumeGeometry*>(r.appearance->getChild(0));
    if (r.volume) r.set = r.volume->getTetraSet().get();
    return r;
}

void expectMesh(const Read& r)
{
    ASSERT_TRUE(r.set) << r.error;
    EXPECT_NEAR(core::volume(*r.set), VOLUME, 1e-12);
    EXPECT_TRUE(core::findAdjacency(*r.set).nonManifold.empty());
    // The three neighbours and the tetrahedron hang together.
    std::size_t shared = 0;
    for (const auto& n : core::findAdjacency(*r.set).neighbours)
        for (const int t : n)
            shared += t != core::Adjacency::NONE ? 1u : 0u;
    EXPECT_GT(shared, 2u * 4u);
}

} // namespace

TEST(VtkReader, PointsHaveTheirScalarsInBothFormats)
{
    for (const bool isXml : {false, true}) {
        const Read r = read(isXml ? xml() : legacyScalars(), isXml ? "vtu" : "vtk");
        expectMesh(r);
        ASSERT_TRUE(r.volume && r.volume->getScalars());
        EXPECT_FALSE(r.appearance->getVoxels());
        EXPECT_EQ(r.volume->getScalarBinding(), VolumeGeometry::PER_VERTEX);
        EXPECT_EQ(r.volume->getScalarRange(), osg::Vec2d(0.0, 190.0));
        EXPECT_TRUE(r.volume->isScalarRangeAutomatic());
        ASSERT_EQ(r.volume->getScalars()->size(), static_cast<std::size_t>(POINT_COUNT));
        for (std::size_t i = 0; i < POINT_COUNT; ++i)
            EXPECT_EQ((*r.volume->getScalars())[i], 10.0f * float(i));
    }
}

TEST(VtkReader, TetrahedraHaveTheValueOfTheirCell)
{
    // Of the volumes of the cells, in their order.
    const double volumes[] = {1.0, 1.0 / 3.0, 0.5, 1.0, 1.0 / 6.0};
    const std::string points = "SCALARS both double 1\nLOOKUP_TABLE default\n" + scalars() + "\n";
    const std::string cells = "CELL_DATA 6\nSCALARS both double 1\nLOOKUP_TABLE default\n"
                              "10 11 12 13 14 15\nSCALARS other float 1\nLOOKUP_TABLE default\n"
                              "20 21 22 23 24 25\n";
    const std::string file = legacy(points + cells);
    for (const auto& [options, first] :
         {std::pair("scalars=cells:both", 10.0f), {"dataset=other", 20.0f}}) {
        const Read r = read(file, "vtk", options);
        expectMesh(r);
        ASSERT_TRUE(r.volume && r.volume->getScalars());
        EXPECT_EQ(r.volume->getScalarBinding(), VolumeGeometry::PER_TETRAHEDRON);
        EXPECT_EQ(r.volume->getScalarRange(), osg::Vec2d(first, first + 4.0));
        double sums[5] = {};
        for (std::size_t t = 0; t < r.set->tetraCount(); ++t) {
            const float cell = (*r.volume->getScalars())[t] - first;
            ASSERT_TRUE(cell >= 0.0f && cell < 5.0f);
            sums[int(cell)] += std::abs(core::orientation(*r.set, t)) / 6.0;
        }
        for (int c = 0; c < 5; ++c)
            EXPECT_NEAR(sums[c], volumes[c], 1e-12) << c;
    }
    // Points come first.
    for (const char* options : {"", "scalars=both", "scalars=points:both"}) {
        const Read r = read(file, "vtk", options);
        ASSERT_TRUE(r.volume && r.volume->getScalars()) << r.error;
        EXPECT_EQ(r.volume->getScalarBinding(), VolumeGeometry::PER_VERTEX) << options;
    }
    const Read none = read(file, "vtk", "scalars=none");
    EXPECT_NE(none.error.find("\"none\"; there are: both, cells:both, other"), std::string::npos)
        << none.error;
}

TEST(VtkReader, OptionsChooseArrayTableAndUnit)
{
    const std::string table = folder() + "/VtkReaderTest.lut";
    std::ofstream(table) << "0 1 0 0 0.1\n190 0 0 1 0.9\n";
    const Read r = read(xml(), "vtu", "scalars=b table=VtkReaderTest.lut unit=3");
    ASSERT_TRUE(r.set) << r.error;
    EXPECT_EQ(r.appearance->getChild(0)->getName(), "b");
    EXPECT_EQ(r.appearance->getOpacityUnit(), 3.0);
    EXPECT_EQ(r.appearance->getLookupTable()->getDomain(), LookupTable::DATA_VALUES);
    EXPECT_FALSE(read(xml(), "vtu", "table=none.lut").appearance);
    EXPECT_FALSE(read(xml(), "vtu", "unit=-1").appearance);
    EXPECT_NE(read(xml(), "vtu", "scalars=c").error.find("\"c\"; there are: a, b"),
              std::string::npos);
}

TEST(VtkReader, ColoursAreCarriedAsTheyAre)
{
    for (const int components : {3, 4}) {
        const Read r = read(legacy("SCALARS paint unsigned_char " + std::to_string(components) +
                                   "\nLOOKUP_TABLE default\n" + scalars(components) + "\n"),
                            "vtk");
        expectMesh(r);
        ASSERT_TRUE(r.set);
        EXPECT_FALSE(r.appearance->getVoxels());
        EXPECT_FALSE(r.volume->getScalars());
        EXPECT_EQ(r.set->vertices.format().colorSize, 4);
        EXPECT_NEAR(r.set->vertices.record(0)[1], 1.0 / 255.0, 1e-12);
        EXPECT_NEAR(r.set->vertices.record(0)[3], components == 3 ? 1.0 : 1.0 / 255.0, 1e-12);
    }
}

TEST(VtkReader, PipesAndDevicesAreRefusedAtOnce)
{
    const support::Watchdog watchdog;
    for (const std::string extension : {"vtk", "vtu"}) {
        const std::string pipe = testing::TempDir() + "VtkReaderTest.pipe." + extension;
        const std::string zero = testing::TempDir() + "VtkReaderTest.zero." + extension;
        for (const std::string& name : {pipe, zero})
            std::filesystem::remove(name);
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        std::filesystem::create_symlink("/dev/zero", zero);
        for (const std::string& name : {pipe, zero}) {
            clearLastError();
            EXPECT_FALSE(osgDB::readRefNodeFile(name).valid());
            EXPECT_NE(getLastError().text.find("is no regular file"), std::string::npos)
                << getLastError().text;
            std::filesystem::remove(name);
        }
    }
}

TEST(VtkReader, BadFilesAreRefusedInASentence)
{
    const std::string good = legacyScalars();
    const std::pair<std::string, std::string> bad[] = {
        {"", "UNSTRUCTURED_GRID"},
        {"nonsense", "UNSTRUCTURED_GRID"},
        {replaced(good, "UNSTRUCTURED_GRID", "POLYDATA"), "UNSTRUCTURED_GRID"},
        {replaced(good, "14 15 16 17 18 19\n", "14 15 16 17 18 99\n"), "cell 2 refers to point 99"},
        {replaced(good, "14 15 16 17 18 19\n", "14 15 16 17 18 -9\n"), "cell 2 refers to point -9"},
        {replaced(good, "CELLS 6 40", "CELLS 6 38"), "38 numbers"},
        {replaced(good, "CELLS 6 40", "CELLS 6 44"), "CELLS"},
        {replaced(good, "CELLS 6 40", "CELLS 5 40"), "CELLS"},
        {replaced(good, "CELLS 6 40", "CELLS 99999999999999 40"), "CELLS"},
        {replaced(good, "\n12\n", "\n25\n"), "cell 0 has 8 points"},
        {replaced(good, "\n12\n", "\n13\n"), "cell 0 has 8 points"},
        {replaced(good, "\n12\n", "\n42\n"), "faces that do not end with cell 0"},
        {replaced(good, "\n12\n14\n13\n11\n10\n5\n", "\n1\n2\n3\n200\n55\n5\n"),
         "no cells to show, but 4 points, lines or faces, 2 of unknown kinds"},
        {legacy(""), "no arrays of numbers"},
        {replaced(good, "POINTS 20", "POINTS -2"), "section POINTS cannot have -2"},
        {replaced(good, "POINT_DATA 20", "POINT_DATA 99999999999"), "section POINT_DATA"},
        {replaced(good, "CELL_TYPES 6", "CELL_TYPES -6"), "section CELL_TYPES"},
        {replaced(good, "Version 3.0", "Version 5.0"), "not what the file's version has"},
        {good.substr(0, good.find("CELL_TYPES")), ""},
        {good.substr(0, good.find("CELLS") + 20), ""},
        {good.substr(0, good.find("POINTS") + 30), ""}};
    for (const auto& [content, words] : bad) {
        const Read r = read(content, "vtk");
        EXPECT_FALSE(r.appearance) << words;
        EXPECT_NE(r.error.find("VtkReaderTest.vtk"), std::string::npos) << r.error;
        EXPECT_NE(r.error.find(words), std::string::npos) << r.error;
        EXPECT_EQ(r.error.find('\n'), std::string::npos) << r.error;
    }
    const std::string tree = xml();
    for (const std::string& content :
         {std::string(), std::string("<VTKFile"), tree.substr(0, tree.size() / 2),
          replaced(tree, "NumberOfCells=\"6\"", "NumberOfCells=\"7\""),
          replaced(tree, "14 15 16 17 18 19", "14 15 16 17 18 99")}) {
        const Read r = read(content, "vtu");
        EXPECT_FALSE(r.appearance) << content;
        EXPECT_FALSE(r.error.empty());
    }
    EXPECT_FALSE(osgDB::readRefNodeFile("missing.vtu"));
}

// A cube of hexahedra whose scalar is linear shows the same as voxels with these values.
class VtkReaderPicture : public support::GLTest
{
protected:
    static constexpr int CELLS = 4;
    static constexpr double SIZE = 16.0;

    static std::string cube()
    {
        const int m = CELLS + 1, points = m * m * m;
        std::string at, values, corners, types;
        for (int i = 0; i < points; ++i) {
            const int x = i % m, y = i / m % m, z = i / m / m;
            for (const int v : {x, y, z})
                at += std::to_string(v * SIZE / CELLS) + " ";
            values += std::to_string(x + 2 * z) + " ";
            if (x == CELLS || y == CELLS || z == CELLS) continue;
            corners += "8 ";
            for (const int o : {0, 1, m + 1, m, m * m, m * m + 1, m * m + m + 1, m * m + m})
                corners += std::to_string(i + o) + " ";
            types += "12 ";
        }
        const std::string cells = std::to_string(CELLS * CELLS * CELLS);
        return "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
               std::to_string(points) + " double\n" + at + "\nCELLS " + cells + " " +
               std::to_string(9 * CELLS * CELLS * CELLS) + "\n" + corners + "\nCELL_TYPES " +
               cells + "\n" + types + "\nPOINT_DATA " + std::to_string(points) +
               "\nSCALARS s double 1\nLOOKUP_TABLE default\n" + values + "\n";
    }
    static osg::ref_ptr<VolumeAppearance> voxelsOfTheSame()
    {
        VoxelSource::Description description;
        description.size = {17, 17, 17};
        description.type = VoxelType::FLOAT32;
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        source->allocate(description);
        auto* out = static_cast<float*>(source->data());
        for (int i = 0; i < 17 * 17 * 17; ++i)
            *out++ = static_cast<float>(i % 17 + 2 * (i / 289)) * float(CELLS / SIZE);
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        voxels->setRange(osg::Vec2d(0.0, 3.0 * CELLS));
        osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
        appearance->setVoxels(voxels);
        appearance->addChild(VolumeGeometry::createBox(*voxels));
        return appearance;
    }
};

TEST_F(VtkReaderPicture, ScalarsShowAsVoxelsDo)
{
    const Read mesh = read(cube(), "vtk", "unit=4");
    ASSERT_TRUE(mesh.appearance) << mesh.error;
    const osg::ref_ptr<VolumeAppearance> voxels = voxelsOfTheSame();
    osg::ref_ptr<LookupTable> table = new LookupTable;
    table->setPoints(
        {{0.0, {0.1, 0.2, 0.9, 0.0}}, {0.6, {0.2, 1.0, 0.2, 0.2}}, {1.0, {1.0, 0.5, 0.1, 0.9}}},
        LookupTable::RANGE_FRACTION);
    for (VolumeAppearance* a : {mesh.appearance.get(), voxels.get()}) {
        a->setLookupTable(table);
        ASSERT_TRUE(a->setOpacityUnit(4.0));
    }
    ASSERT_TRUE(voxels->setSamplingPeriod(osg::Vec3d(0.1, 0.1, 0.1)));
    const support::RenderOptions view =
        support::RenderOptions().size(64, 64).orthographic(12.0).lookAt({30, -25, 20}, {8, 8, 8},
                                                                        {0, 0, 1});
    const support::FloatImage a = support::renderScene(mesh.appearance, view);
    const support::FloatImage b = support::renderScene(voxels, view);
    EXPECT_GT(support::coveredPixels(a, 0.2f).count(), 500u);
    // The scalars are linear, so that both interpolate them exactly.
    EXPECT_LE(support::compare(a, b).rmse, 1e-4);
}

} // namespace VtkReaderTest

#endif
