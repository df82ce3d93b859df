// NetCDF and Zarr by GDAL, against what was written to them.

#ifdef OSGVOLUMIZER_HAVE_GDAL

#include "GdalFiles.h"

#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/Paging.h>
#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/core/voxels/BrickTree.h>
#include <osgVolumizer/io/Placement.h>

#include <support/GLTest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

namespace GdalTest {

using namespace osgVolumizer;
using core::Box3i;
namespace fs = std::filesystem;

namespace {

class Gdal : public GdalFolderTest
{
protected:
    static void expectPlace(const VoxelSource& source, const glm::dvec3& voxel,
                            const glm::dvec3& expected, double tolerance = 1e-9)
    {
        const glm::dvec3 found = io::placeOf(source.describe(), voxel);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found[axis], expected[axis],
                        tolerance * std::max(1.0, std::fabs(expected[axis])))
                << "axis " << axis << " of voxel " << voxel.x << "," << voxel.y << "," << voxel.z;
    }
    static int holesIn(const std::vector<float>& values)
    {
        int holes = 0;
        for (const float v : values)
            holes += std::isnan(v);
        return holes;
    }
};

const std::vector<double> LONGITUDES{10, 12, 14, 16, 18, 20}, LATITUDES{50, 49, 48, 47, 46};

} // namespace

TEST_F(Gdal, AxesTimeAndDescendingLatitude)
{
    for (const char* driver : {"netCDF", "Zarr"}) {
        const std::string name = std::string("a.") + (driver[0] == 'Z' ? "zarr" : "nc");
        {
            GdalWriter file(path(name), driver);
            const auto time = file.dimension("t", 3, {0, 6, 12}, "hours since 2000-01-01");
            const auto level = file.dimension("level", 4, {1, 2, 3, 4}, "1");
            const auto latitude = file.dimension("lat", 5, LATITUDES, "degrees_north");
            const auto longitude = file.dimension("lon", 6, LONGITUDES, "degrees_east");
            file.array(file.root(), "temperature", {time, level, latitude, longitude},
                       volume<float>(6, 5, 4, 3), GDT_Float32)
                ->SetUnit("K");
        }
        const auto voxels = read(name);
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        EXPECT_EQ((*voxels)->getSize(), osg::Vec3i(6, 5, 4));
        EXPECT_EQ((*voxels)->getType(), VoxelType::FLOAT32);
        EXPECT_EQ((*voxels)->getStepCount(), 3);
        const VoxelSource& source = *(*voxels)->getSource();
        for (int step = 0; step < 3; ++step) {
            const auto one = samples<float>(source, {{1, 2, 1}, {5, 5, 3}}, 0, step);
            std::size_t i = 0;
            for (int z = 1; z < 3; ++z)
                for (int y = 2; y < 5; ++y)
                    for (int x = 1; x < 5; ++x)
                        EXPECT_EQ(one[i++], float(value(x, y, z, step))) << step;
        }
        // Row 0 is the northernmost, and nothing is mirrored.
        expectPlace(source, {0, 0, 0}, {10, 50, 1});
        expectPlace(source, {5, 4, 3}, {20, 46, 4});
        EXPECT_EQ(source.describe().axes[1], glm::dvec3(0, -1, 0));
        const auto entries = listVolumes(path(name));
        ASSERT_TRUE(entries.ok()) << entries.status.text;
        ASSERT_EQ(entries->size(), 1u);
        EXPECT_EQ(entries->front().name, "/temperature");
        EXPECT_EQ(entries->front().text, "temperature (t 3, level 4, lat 5, lon 6) K");
        EXPECT_EQ(entries->front().size, osg::Vec3i(6, 5, 4));
        EXPECT_EQ(entries->front().steps, 3);
        EXPECT_TRUE(entries->front().chosen);
    }
}

TEST_F(Gdal, DimensionsByNameAndInAnyOrder)
{
    {
        GdalWriter file(path("order.nc"), "netCDF");
        const auto a = file.dimension("a", 4), b = file.dimension("b", 5),
                   c = file.dimension("c", 6), one = file.dimension("one", 1),
                   many = file.dimension("many", 2);
        file.array(file.root(), "v", {a, b, c}, volume<std::uint8_t>(6, 5, 4), GDT_Byte);
        file.array(file.root(), "thin", {a, one, b, c}, volume<std::uint8_t>(6, 5, 4), GDT_Byte);
        file.array(file.root(), "five", {many, a, one, b, c}, volume<std::uint8_t>(6, 5, 4, 2),
                   GDT_Byte);
        // Attributes go before positions.
        const auto x = file.dimension("first", 3, {0, 1, 2}, "degrees_east");
        const auto y = file.dimension("second", 4, {0, 1, 2, 3}, "degrees_north");
        file.array(file.root(), "turned", {x, y}, volume<std::uint8_t>(4, 3, 1), GDT_Byte);
    }
    const auto sizeBy = [this](const std::string& options) {
        const auto source = open("order.nc", options);
        return source ? source->describe().size : glm::ivec3(0);
    };
    EXPECT_EQ(sizeBy("dataset=v"), glm::ivec3(6, 5, 4));
    EXPECT_EQ(sizeBy("dataset=thin"), glm::ivec3(6, 5, 4));
    EXPECT_EQ(sizeBy("dataset=turned"), glm::ivec3(3, 4, 1));
    EXPECT_EQ(sizeBy("dataset=v dimensions=a,c,b"), glm::ivec3(4, 6, 5));
    const auto other = open("order.nc", "dataset=/v dimensions=a,b,c");
    ASSERT_TRUE(other);
    const auto found = all<std::uint8_t>(*other);
    std::size_t i = 0;
    for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 4; ++x)
                EXPECT_EQ(found[i++], value(z, y, x));
    const auto five = open("order.nc"); // the largest
    ASSERT_TRUE(five);
    EXPECT_EQ(five->stepCount(), 2);
    EXPECT_EQ(all<std::uint8_t>(*five, 1)[0], value(0, 0, 0, 1));
    const auto first = open("order.nc", "dataset=five dimensions=c,b,a");
    ASSERT_TRUE(first);
    EXPECT_EQ(first->stepCount(), 1);
    const auto wrong = read("order.nc", "dataset=v dimensions=a,b,d");
    EXPECT_EQ(wrong.status.code, ErrorCode::VALUE_INVALID);
    EXPECT_NE(wrong.status.text.find("there are a, b, c"), std::string::npos) << wrong.status.text;
    EXPECT_EQ(read("order.nc", "dataset=v dimensions=a,b,a").status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(read("order.nc", "dataset=v channel=1").status.code, ErrorCode::INDEX_OUT_OF_RANGE);
}

TEST_F(Gdal, ScaleOffsetAndWhatIsMissing)
{
    // 12 numbers, of which three are none.
    const std::vector<std::int16_t> packed{0, 1, 2, 3, -32768, 5, -999, 7, 2000, 9, 10, 11};
    for (const char* driver : {"netCDF", "Zarr"}) {
        const std::string name = std::string("packed.") + (driver[0] == 'Z' ? "zarr" : "nc");
        {
            GdalWriter file(path(name), driver);
            const auto x = file.dimension("x", 3), y = file.dimension("y", 2),
                       z = file.dimension("z", 2);
            file.array(file.root(), "packed", {z, y, x}, packed, GDT_Int16,
                       {{"_FillValue", -32768},
                        {"missing_value", -999},
                        {"valid_max", 1000},
                        {"scale_factor", 0.5},
                        {"add_offset", 273.25}});
            file.array(file.root(), "whole", {z, y, x}, packed, GDT_Int16);
            file.array(file.root(), "holes", {z, y, x}, packed, GDT_Int16, {{"_FillValue", -999}});
            file.array(file.root(), "wide", {z, y, x},
                       std::vector<std::int32_t>{0, 16777217, -1, 3, 4, 5, 6, 7, 8, 9, 10, 11},
                       GDT_Int32, {{"_FillValue", -1}});
        }
        const auto source = open(name, "dataset=packed"), whole = open(name, "dataset=whole"),
                   holes = open(name, "dataset=holes"), wide = open(name, "dataset=wide");
        ASSERT_TRUE(source && whole && holes && wide) << driver;
        EXPECT_EQ(source->describe().type, VoxelType::FLOAT32);
        const auto found = all<float>(*source);
        for (std::size_t i = 0; i < packed.size(); ++i) {
            if (i == 4 || i == 6 || i == 8) {
                EXPECT_TRUE(std::isnan(found[i])) << driver << " " << i;
            } else {
                EXPECT_EQ(found[i], float(273.25 + 0.5 * packed[i])) << driver << " " << i;
            }
        }
        // Plain numbers stay what they are.
        EXPECT_EQ(whole->describe().type, VoxelType::INT16);
        EXPECT_EQ(all<std::int16_t>(*whole), packed);
        EXPECT_EQ(holes->describe().type, VoxelType::FLOAT32);
        const auto some = all<float>(*holes);
        EXPECT_EQ(holesIn(some), 1);
        EXPECT_EQ(some[4], -32768.0f);
        // What floats would round.
        EXPECT_EQ(wide->describe().type, VoxelType::FLOAT64);
        const auto exact = all<double>(*wide);
        EXPECT_EQ(exact[1], 16777217.0);
        EXPECT_TRUE(std::isnan(exact[2]));
        // Holes are no part of the range.
        EXPECT_EQ((*read(name, "dataset=packed"))->getRange(), osg::Vec2d(273.25, 278.75));
    }
}

TEST_F(Gdal, FillValuesOfFloatsAndZeros)
{
    {
        GdalWriter file(path("floats.nc"), "netCDF");
        const auto x = file.dimension("x", 2), y = file.dimension("y", 2),
                   z = file.dimension("z", 2);
        file.array(file.root(), "v", {z, y, x},
                   std::vector<float>{0, 1, 2, 3, 1e20f, 5, 6, std::nanf("")}, GDT_Float32,
                   {{"_FillValue", 1e20}});
        file.array(file.root(), "none", {z, y, x}, std::vector<float>(), GDT_Float32);
    }
    {
        GdalWriter file(path("zeros.zarr"), "Zarr");
        const auto x = file.dimension("x", 2), y = file.dimension("y", 2),
                   z = file.dimension("z", 2);
        file.array(file.root(), "v", {z, y, x}, std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5, 6, 7},
                   GDT_Byte, {{"_FillValue", 0}});
    }
    const auto floats = open("floats.nc", "dataset=v"), none = open("floats.nc", "dataset=none"),
               zeros = open("zeros.zarr");
    ASSERT_TRUE(floats && none && zeros);
    const auto found = all<float>(*floats);
    EXPECT_EQ(found[0], 0.0f);
    EXPECT_TRUE(std::isnan(found[4]));
    EXPECT_EQ(holesIn(found), 2);
    EXPECT_EQ(holesIn(all<float>(*none)), 8); // never written
    // The fill value of Zarr is 0 unless somebody says so: nothing is missing.
    EXPECT_EQ(zeros->describe().type, VoxelType::UINT8);
    EXPECT_EQ(all<std::uint8_t>(*zeros)[0], 0);
}

TEST_F(Gdal, LongIntegersBecomeWhatHoldsThem)
{
    const std::vector<std::int64_t> small{-5, 0, 1, 300, 4, 5, 6, 7},
        large{0, std::int64_t(1) << 40, 2, 3, 4, 5, 6, 7};
    const std::vector<double> doubles{0.1, 1e300, 2, 3, 4, 5, 6, 7};
    {
        GdalWriter file(path("long.nc"), "netCDF");
        const auto x = file.dimension("x", 2), y = file.dimension("y", 2),
                   z = file.dimension("z", 2);
        file.array(file.root(), "small", {z, y, x}, small, GDT_Int64);
        file.array(file.root(), "large", {z, y, x}, large, GDT_Int64);
        file.array(file.root(), "doubles", {z, y, x}, doubles, GDT_Float64);
    }
    const auto a = open("long.nc", "dataset=small"), b = open("long.nc", "dataset=large"),
               c = open("long.nc", "dataset=doubles");
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(a->describe().type, VoxelType::INT16);
    EXPECT_EQ(all<std::int16_t>(*a)[3], 300);
    EXPECT_EQ(b->describe().type, VoxelType::FLOAT64);
    EXPECT_EQ(all<double>(*b)[1], std::ldexp(1.0, 40));
    EXPECT_EQ(all<double>(*c), doubles);
}

TEST_F(Gdal, UnevenLevelsAreInterpolated)
{
    // Of 4 hPa, the smallest gap is 100 of 700: samples at 1000, 900, ... 300.
    const std::vector<double> pressures{1000, 900, 700, 300};
    {
        GdalWriter file(path("uneven.nc"), "netCDF");
        const auto z = file.dimension("plev", 4, pressures, "hPa", GDT_Float32);
        const auto y = file.dimension("lat", 2, {50, 40}, "degrees_north", GDT_Float32);
        const auto x = file.dimension("lon", 2, {0, 1000}, "degrees_east", GDT_Float32);
        file.array(
            file.root(), "v", {z, y, x},
            std::vector<std::int16_t>{0, 1, 2, 3, 10, 11, 12, 13, 30, 31, -9, 33, 70, 71, 72, 73},
            GDT_Int16, {{"missing_value", -9}});
    }
    const auto source = open("uneven.nc");
    ASSERT_TRUE(source);
    ASSERT_EQ(source->describe().size, glm::ivec3(2, 2, 8));
    EXPECT_EQ(source->describe().type, VoxelType::FLOAT32);
    const auto found = all<float>(*source);
    // The value is linear in pressure, but where there is a hole.
    for (int k = 0; k < 8; ++k)
        for (int i = 0; i < 4; ++i)
            if (i != 2) {
                EXPECT_NEAR(found[std::size_t(4 * k + i)], 10 * k + i, 1e-5) << k;
            }
    const float column[] = {2, 12, 12, NAN, NAN, NAN, 72, 72}; // the nearer of the two counts
    for (int k : {0, 1, 3, 4, 6, 7}) {
        const float v = found[std::size_t(4 * k + 2)];
        EXPECT_TRUE(v == column[k] || (std::isnan(v) && std::isnan(column[k]))) << k << ": " << v;
    }
    // A part is the same as all of it.
    const auto part = samples<float>(*source, {{1, 0, 2}, {2, 2, 6}});
    for (int k = 2; k < 6; ++k)
        EXPECT_EQ(part[std::size_t(2 * (k - 2))], found[std::size_t(4 * k + 1)]);
    expectPlace(*source, {0, 0, 0}, {0, 50, -1000}); // pressures are higher below
    expectPlace(*source, {1, 1, 7}, {1000, 40, -300});
}

TEST_F(Gdal, DegreesBesideMetresBecomeMetres)
{
    {
        GdalWriter file(path("depth.nc"), "netCDF");
        const auto z = file.dimension("depth", 3, {0, 100, 200}, "m", GDT_Float64, "down");
        const auto y = file.dimension("lat", 3, {59, 60, 61}, "degrees_north");
        const auto x = file.dimension("lon", 2, {10, 11}, "degrees_east");
        file.array(file.root(), "salt", {z, y, x}, volume<std::uint8_t>(2, 3, 3), GDT_Byte);
        const auto flat = file.dimension("p", 3, {0, 1e5, 2e5}, "Pa");
        file.array(file.root(), "by_pressure", {flat, y, x}, volume<std::uint8_t>(2, 3, 3),
                   GDT_Byte);
    }
    const auto source = open("depth.nc", "dataset=salt");
    ASSERT_TRUE(source);
    constexpr double DEGREE = 111195.0; // metres
    expectPlace(*source, {0, 0, 0}, {10 * 0.5 * DEGREE, 59 * DEGREE, 0});
    expectPlace(*source, {1, 2, 2}, {11 * 0.5 * DEGREE, 61 * DEGREE, -200}); // depth is below
    // Nor is a pressure a thousand times as high as the land is wide.
    const auto pressure = open("depth.nc", "dataset=by_pressure");
    ASSERT_TRUE(pressure);
    expectPlace(*pressure, {1, 2, 2}, {11, 61, -0.5});
}

// GDAL takes every length for upright.
TEST_F(Gdal, LengthsAlongXYAndZStayWhereTheyAre)
{
    {
        GdalWriter file(path("metres.nc"), "netCDF");
        const auto z = file.dimension("z", 3, {0, 5, 10}, "m");
        const auto y = file.dimension("y", 4, {0, 20, 40, 60}, "m");
        const auto x = file.dimension("x", 5, {0, 10, 20, 30, 40}, "m");
        const auto sigma = file.dimension("sigma", 2, {1, 2}, "m");
        file.array(file.root(), "v", {z, y, x}, volume<std::uint8_t>(5, 4, 3), GDT_Byte);
        // Of what nothing is known but a length.
        file.array(file.root(), "up", {y, x, sigma}, volume<std::uint8_t>(2, 5, 4), GDT_Byte);
    }
    const auto source = open("metres.nc", "dataset=v"), up = open("metres.nc", "dataset=up");
    ASSERT_TRUE(source && up);
    EXPECT_EQ(source->describe().size, glm::ivec3(5, 4, 3));
    EXPECT_EQ(all<std::uint8_t>(*source), volume<std::uint8_t>(5, 4, 3));
    expectPlace(*source, {4, 3, 2}, {40, 60, 10});
    EXPECT_EQ(up->describe().size, glm::ivec3(5, 4, 2));
}

TEST_F(Gdal, PressuresAndDepthsAreHigherBelow)
{
    const auto lastOf = [this](const char* name, const char* unit, const char* positive) {
        {
            GdalWriter file(path("down.nc"), "netCDF");
            const auto z = file.dimension(name, 3, {1, 2, 3}, unit, GDT_Float64, positive);
            const auto y = file.dimension("y", 3, {0, 1, 2}), x = file.dimension("x", 3, {0, 1, 2});
            file.array(file.root(), "v", {z, y, x}, volume<std::uint8_t>(3, 3, 3), GDT_Byte);
        }
        const auto source = open("down.nc");
        return source ? io::placeOf(source->describe(), {2, 2, 2}) : glm::dvec3(0.0);
    };
    EXPECT_EQ(lastOf("lev", "hPa", ""), glm::dvec3(2, 2, -3));
    EXPECT_EQ(lastOf("lev", "millibar", ""), glm::dvec3(2, 2, -3));
    EXPECT_EQ(lastOf("lev", "hPa", "up"), glm::dvec3(2, 2, 3));
    EXPECT_EQ(lastOf("depth", "m", ""), glm::dvec3(2, 2, -3));
    EXPECT_EQ(lastOf("height", "m", ""), glm::dvec3(2, 2, 3));
    EXPECT_EQ(lastOf("height", "m", "down"), glm::dvec3(2, 2, -3));
}

TEST_F(Gdal, LengthsOfSeveralUnitsBecomeMetres)
{
    {
        GdalWriter file(path("km.nc"), "netCDF");
        const auto x = file.dimension("x", 3, {0, 10, 20}, "km"),
                   y = file.dimension("y", 3, {1, 11, 21}, "km"),
                   z = file.dimension("z", 3, {0, 500, 1000}, "m"),
                   level = file.dimension("level", 3, {1, 2, 3}, "1");
        file.array(file.root(), "v", {z, y, x}, volume<std::uint8_t>(3, 3, 3), GDT_Byte);
        const auto east = file.dimension("easting", 3, {0, 10000, 20000}, "m"),
                   north = file.dimension("northing", 3, {0, 10000, 20000}, "m");
        file.array(file.root(), "flat", {level, north, east}, volume<std::uint8_t>(3, 3, 3),
                   GDT_Byte);
    }
    const auto source = open("km.nc", "dataset=v"), flat = open("km.nc", "dataset=flat");
    ASSERT_TRUE(source && flat);
    expectPlace(*source, {2, 2, 2}, {20000, 21000, 1000});
    // A number of levels has a quarter of the width.
    expectPlace(*flat, {0, 0, 0}, {0, 0, 2500});
    expectPlace(*flat, {2, 2, 2}, {20000, 20000, 7500});
}

TEST_F(Gdal, LongitudesAcrossTheDateLineAndDoublesThatWereFloats)
{
    std::vector<double> rounded;
    for (int i = 0; i < 3600; ++i)
        rounded.push_back(double(static_cast<float>(0.1 * i)));
    {
        GdalWriter file(path("wrap.nc"), "netCDF");
        const auto y = file.dimension("lat", 2, {50, 40}, "degrees_north"),
                   x = file.dimension("lon", 6, {170, 175, -180, -175, -170, -165}, "degrees_east");
        file.array(file.root(), "wrap", {y, x}, volume<std::uint8_t>(6, 2, 1), GDT_Byte);
        const auto fine = file.dimension("longitude", 3600, rounded, "degrees_east");
        file.array(file.root(), "even", {y, fine}, volume<std::uint8_t>(3600, 2, 1), GDT_Byte);
    }
    const auto wrap = open("wrap.nc", "dataset=wrap"), even = open("wrap.nc", "dataset=even");
    ASSERT_TRUE(wrap && even);
    EXPECT_EQ(all<std::uint8_t>(*wrap), volume<std::uint8_t>(6, 2, 1));
    expectPlace(*wrap, {0, 0, 0}, {170, 50, 0});
    expectPlace(*wrap, {5, 1, 0}, {195, 40, 0});
    EXPECT_EQ(even->describe().type, VoxelType::UINT8);
    EXPECT_EQ(even->describe().size, glm::ivec3(3600, 2, 1));
}

TEST_F(Gdal, WhatNetCdfFillsIntegersWithIsMissing)
{
    const std::vector<std::int16_t> filled{0, 1, -32767, 3, 4, 5, 6, -32768};
    {
        GdalWriter file(path("filled.nc"), "netCDF");
        const auto x = file.dimension("x", 2), y = file.dimension("y", 2),
                   z = file.dimension("z", 2);
        file.array(file.root(), "plain", {z, y, x}, filled, GDT_Int16);
        file.array(file.root(), "scaled", {z, y, x}, filled, GDT_Int16, {{"scale_factor", 0.5}});
        file.array(file.root(), "said", {z, y, x}, filled, GDT_Int16, {{"missing_value", 1}});
        file.array(file.root(), "never", {z, y, x}, std::vector<std::int32_t>(), GDT_Int32);
        const auto uneven = file.dimension("height", 3, {0, 1, 3}, "m");
        file.array(file.root(), "between", {uneven, y, x},
                   std::vector<std::int16_t>{0, 1, 2, 3, -32767, 5, 6, 7, 8, 9, 10, 11}, GDT_Int16);
    }
    const auto holesOf = [this](const std::string& name, VoxelType type) {
        const auto source = open("filled.nc", "dataset=" + name);
        if (!source || source->describe().type != type) return -1;
        if (type == VoxelType::FLOAT32) return holesIn(all<float>(*source));
        const std::vector<double> values = all<double>(*source);
        return int(std::count_if(values.begin(), values.end(), [](double v) { return v != v; }));
    };
    EXPECT_EQ(holesOf("plain", VoxelType::FLOAT32), 1);
    EXPECT_EQ(holesOf("scaled", VoxelType::FLOAT32), 1);
    EXPECT_EQ(all<float>(*open("filled.nc", "dataset=scaled"))[7], -16384.0f);
    EXPECT_EQ(all<float>(*open("filled.nc", "dataset=said"))[2], -32767.0f);
    EXPECT_EQ(holesOf("never", VoxelType::FLOAT64), 8);
    EXPECT_EQ(holesOf("between", VoxelType::FLOAT32), 1);
    const auto entries = listVolumes(path("filled.nc"));
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    EXPECT_EQ(entries->front().name, "/plain");
    EXPECT_EQ(entries->front().type, VoxelType::FLOAT32);
}

TEST_F(Gdal, LongIntegersAreNarrowedWhereAllStepsAreFewBytes)
{
    {
        GdalWriter file(path("steps.nc"), "netCDF");
        const auto t = file.dimension("time", 8), x = file.dimension("x", 32),
                   y = file.dimension("y", 32), z = file.dimension("z", 32);
        file.array(file.root(), "v", {t, z, y, x}, volume<std::int64_t>(32, 32, 32, 8), GDT_Int64);
    }
    const auto typeOf = [this] {
        const auto source = open("steps.nc");
        const auto entries = listVolumes(path("steps.nc"));
        EXPECT_TRUE(source && entries.ok());
        if (!source || !entries.ok()) return VoxelType::HALF;
        EXPECT_EQ(entries->front().type, source->describe().type);
        return source->describe().type;
    };
    EXPECT_EQ(typeOf(), VoxelType::UINT8);
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20; // four steps of doubles
    ASSERT_TRUE(setPagingBudget(small));
    const VoxelType found = typeOf();
    ASSERT_TRUE(setPagingBudget(before));
    EXPECT_EQ(found, VoxelType::FLOAT64);
}

TEST_F(Gdal, WithoutAVolumeItSaysSo)
{
    {
        GdalWriter file(path("line.nc"), "netCDF", "FORMAT=NC");
        const auto x = file.dimension("x", 4);
        file.array(file.root(), "v", {x}, volume<std::int16_t>(4, 1, 1), GDT_Int16);
    }
    const auto line = read("line.nc");
    EXPECT_EQ(line.status.code, ErrorCode::FILE_UNREADABLE);
    EXPECT_EQ(line.status.text,
              path("line.nc") + " has no volume: no variable of numbers with two axes");
}

TEST_F(Gdal, OptionsOfTheThreadStayWhatTheyWere)
{
    {
        GdalWriter file(path("option.nc"), "netCDF");
        const auto x = file.dimension("x", 2), y = file.dimension("y", 2);
        file.array(file.root(), "v", {y, x}, volume<std::uint8_t>(2, 2, 1), GDT_Byte);
    }
    CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "mine");
    EXPECT_TRUE(open("option.nc"));
    const char* const after = CPLGetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
    EXPECT_STREQ(after, "mine");
    CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
}

TEST_F(Gdal, GroupsAndUniqueLastParts)
{
    for (const char* driver : {"netCDF", "Zarr"}) {
        const std::string name = std::string("groups.") + (driver[0] == 'Z' ? "zarr" : "nc");
        {
            GdalWriter file(path(name), driver);
            const auto x = file.dimension("x", 4), y = file.dimension("y", 3),
                       z = file.dimension("z", 2);
            const auto a = file.root()->CreateGroup("a"), b = file.root()->CreateGroup("b");
            file.array(a, "same", {z, y, x}, volume<std::uint8_t>(4, 3, 2), GDT_Byte);
            file.array(b, "same", {z, y, x}, std::vector<std::uint8_t>(24, 9), GDT_Byte);
            file.array(b, "other", {y, x}, volume<std::uint8_t>(4, 3, 1), GDT_Byte);
        }
        const auto entries = listVolumes(path(name));
        ASSERT_TRUE(entries.ok()) << entries.status.text;
        ASSERT_EQ(entries->size(), 3u);
        const auto a = open(name, "dataset=/a/same"), b = open(name, "dataset=b/same"),
                   other = open(name, "dataset=other");
        ASSERT_TRUE(a && b && other) << driver;
        EXPECT_EQ(all<std::uint8_t>(*a), volume<std::uint8_t>(4, 3, 2));
        EXPECT_EQ(all<std::uint8_t>(*b), std::vector<std::uint8_t>(24, 9));
        EXPECT_EQ(other->describe().size, glm::ivec3(4, 3, 1));
        const auto both = read(name, "dataset=same"), none = read(name, "dataset=/c");
        EXPECT_EQ(both.status.code, ErrorCode::VALUE_INVALID);
        EXPECT_EQ(none.status.code, ErrorCode::VALUE_INVALID);
        EXPECT_EQ(none.status.text.rfind(path(name), 0), 0u) << none.status.text;
        EXPECT_NE(none.status.text.find("/b/other"), std::string::npos) << none.status.text;
    }
}

TEST_F(Gdal, LevelsOfWhatIsLarge)
{
    {
        GdalWriter file(path("large.nc"), "netCDF");
        const auto x = file.dimension("x", 129), y = file.dimension("y", 130),
                   z = file.dimension("z", 65);
        file.array(file.root(), "v", {z, y, x}, volume<std::uint8_t>(129, 130, 65), GDT_Byte);
    }
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20;
    EXPECT_FALSE((*read("large.nc"))->isPaged());
    ASSERT_TRUE(setPagingBudget(small));
    const auto voxels = read("large.nc");
    ASSERT_TRUE(setPagingBudget(before));
    ASSERT_TRUE(voxels.ok());
    ASSERT_TRUE((*voxels)->isPaged());
    const VoxelSource& source = *(*voxels)->getSource();
    ASSERT_EQ(source.levelCount(), 3);
    for (int level = 0; level < 3; ++level) {
        const glm::ivec3 size = core::BrickTree::levelSize({129, 130, 65}, level);
        const auto found = samples<std::uint8_t>(source, {glm::ivec3(0), size}, level);
        std::vector<std::uint8_t> thinned(found.size());
        ASSERT_TRUE(source.readThinned(level, {glm::ivec3(0), size}, thinned.data()).ok());
        EXPECT_EQ(found, thinned) << level;
    }
    char byte = 0;
    EXPECT_EQ(source.readLevel(3, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(source.readStep(1, 0, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
}

TEST_F(Gdal, ALargeSparseArrayIsReadWhereItIs)
{
    constexpr int EDGE = 6000; // 216 GB
    {
        GdalWriter file(path("sparse.zarr"), "Zarr");
        const auto x = file.dimension("x", EDGE), y = file.dimension("y", EDGE),
                   z = file.dimension("z", EDGE);
        const char* const pieces[] = {"BLOCKSIZE=64,64,64", nullptr};
        const auto array = file.root()->CreateMDArray(
            "v", {z, y, x}, GDALExtendedDataType::Create(GDT_Byte), pieces);
        ASSERT_TRUE(array);
        const GUInt64 start[] = {5000, 3000, 1000};
        const size_t count[] = {8, 8, 8};
        const std::vector<std::uint8_t> island(512, 200);
        ASSERT_TRUE(array->Write(start, count, nullptr, nullptr,
                                 GDALExtendedDataType::Create(GDT_Byte), island.data()));
    }
    const auto voxels = read("sparse.zarr");
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_TRUE((*voxels)->isPaged());
    const auto found =
        samples<std::uint8_t>(*(*voxels)->getSource(), {{999, 2999, 4999}, {1001, 3001, 5001}});
    EXPECT_EQ(found, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 200}));
}

TEST_F(Gdal, ClassicFilesThatAreCutShort)
{
    for (const char* format : {"FORMAT=NC", "FORMAT=NC2", "FORMAT=NC4"}) {
        {
            GdalWriter file(path("whole.nc"), "netCDF", format);
            const auto x = file.dimension("x", 20), y = file.dimension("y", 10);
            // Records, as time often is.
            const char* const records[] = {"UNLIMITED=YES", nullptr};
            const auto z = file.root()->CreateDimension("z", "", "", 5, records);
            file.array(file.root(), "other", {z}, std::vector<std::int16_t>{1, 2, 3, 4, 5},
                       GDT_Int16);
            GdalWriter::text(
                file.array(file.root(), "v", {z, y, x}, volume<std::int16_t>(20, 10, 5), GDT_Int16),
                "long_name", "what it is");
        }
        std::string magic(3, ' ');
        std::ifstream(path("whole.nc"), std::ios::binary).read(magic.data(), 3);
        EXPECT_EQ(magic == "CDF", std::string(format) != "FORMAT=NC4");
        const auto whole = open("whole.nc");
        ASSERT_TRUE(whole) << format;
        EXPECT_EQ(all<std::int16_t>(*whole), volume<std::int16_t>(20, 10, 5));
        const auto bytes = fs::file_size(path("whole.nc"));
        for (int i = 0; i < 40; ++i) {
            const auto length = i < 39 ? bytes * std::uintmax_t(i) / 39 : bytes - 1;
            if (length == bytes) continue;
            fs::copy_file(path("whole.nc"), path("cut.nc"), fs::copy_options::overwrite_existing);
            fs::resize_file(path("cut.nc"), length);
            const auto cut = read("cut.nc");
            if (cut.ok()) { // what is missing may be found when it is read
                std::vector<std::int16_t> values(1000);
                const auto status =
                    (*cut)->getSource()->read({glm::ivec3(0), {20, 10, 5}}, values.data());
                EXPECT_TRUE(!status.ok() || values == volume<std::int16_t>(20, 10, 5))
                    << format << " " << length << " of " << bytes;
                continue;
            }
            EXPECT_EQ(cut.status.code, ErrorCode::FILE_UNREADABLE) << length;
            EXPECT_EQ(cut.status.text.rfind(path("cut.nc"), 0), 0u) << cut.status.text;
            EXPECT_EQ(cut.status.text.find('\n'), std::string::npos) << cut.status.text;
        }
    }
}

TEST_F(Gdal, NoiseIsRefused)
{
    unsigned state = 1;
    for (const std::string& magic : {std::string("CDF\1"), std::string("CDF\2"),
                                     std::string("CDF\5"), std::string("\x89HDF\r\n\x1a\n")})
        for (int i = 0; i < 50; ++i) {
            std::string bytes = magic;
            // Small numbers get further than large ones.
            for (int k = 0; k < 600; ++k) {
                state = state * 1664525u + 1013904223u;
                const unsigned byte = state >> 24;
                bytes += i % 2 ? char(byte) : char(k % 4 == 3 ? byte % 14 : 0);
            }
            writeBytes("noise.nc", bytes);
            const auto noise = read("noise.nc");
            ASSERT_FALSE(noise.ok());
            EXPECT_EQ(noise.status.text.rfind(path("noise.nc"), 0), 0u) << noise.status.text;
        }
    fs::create_directories(path("folder.zarr"));
    writeBytes("folder.zarr/.zgroup", "{");
    const auto folder = read("folder.zarr");
    ASSERT_FALSE(folder.ok());
    EXPECT_EQ(folder.status.text.rfind(path("folder.zarr"), 0), 0u) << folder.status.text;
}

// Headers that ask for more memory than there is.
TEST_F(Gdal, LargeClaimsAreRefused)
{
    const auto writeHeader = [this](const std::string& name, const std::string& shape,
                                    const std::string& pieces) {
        fs::create_directories(path(name));
        writeBytes(name + "/.zarray",
                   "{\"shape\": [" + shape + "], \"chunks\": [" + pieces +
                       "], \"dtype\": \"<f4\", \"order\": \"C\", \"compressor\": null, "
                       "\"filters\": null, \"fill_value\": 3, \"zarr_format\": 2}");
        return read(name).status;
    };
    EXPECT_EQ(writeHeader("fine.zarr", "100,100,100", "50,50,50").code, ErrorCode::NONE);
    const Status pieces = writeHeader("pieces.zarr", "100000,100000,100000", "4000,4000,4000");
    EXPECT_EQ(pieces.code, ErrorCode::TOO_LARGE) << pieces.text;
    EXPECT_EQ(pieces.text.rfind(path("pieces.zarr"), 0), 0u) << pieces.text;
    EXPECT_EQ(writeHeader("long.zarr", "3000000000,10,10", "10,10,10").code, ErrorCode::TOO_LARGE);
}

TEST_F(Gdal, ThreadsReadSideBySide)
{
    {
        GdalWriter file(path("threads.nc"), "netCDF");
        const auto x = file.dimension("x", 40), y = file.dimension("y", 40),
                   z = file.dimension("z", 40);
        file.array(file.root(), "v", {z, y, x}, volume<std::uint8_t>(40, 40, 40), GDT_Byte);
    }
    const auto shared = open("threads.nc");
    ASSERT_TRUE(shared);
    std::vector<int> wrong(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 30; ++i) {
                const auto own = t % 2 ? open("threads.nc") : shared;
                std::vector<std::uint8_t> found(1000);
                const int first = (i * 7 + int(t)) % 30;
                if (!own->read({glm::ivec3(first), glm::ivec3(first + 10)}, found.data()).ok())
                    ++wrong[t];
                for (int k = 0; k < 1000; ++k)
                    wrong[t] += found[std::size_t(k)] !=
                                value(first + k % 10, first + k / 10 % 10, first + k / 100);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, std::vector<int>(4));
}

// A field with a block that is missing: nothing is drawn there.
TEST_F(Gdal, AHoleIsEmpty)
{
    constexpr int N = 16;
    std::vector<std::int16_t> values;
    for (int z = 0; z < N; ++z)
        for (int y = 0; y < N; ++y)
            for (int x = 0; x < N; ++x)
                values.push_back(x >= 6 ? -999 : std::int16_t(500 + 10 * (y + z)));
    {
        GdalWriter file(path("hole.nc"), "netCDF");
        const auto x = file.dimension("x", N), y = file.dimension("y", N),
                   z = file.dimension("z", N);
        file.array(file.root(), "v", {z, y, x}, values, GDT_Int16,
                   {{"missing_value", -999}, {"scale_factor", 0.5}});
    }
    const auto view = support::RenderOptions().size(64, 64).orthographic(9.0).lookAt(
        {7.5, 7.5, 60}, {7.5, 7.5, 7.5}, {0, 1, 0});
    // Whatever the table shows: cells with nothing but holes are left out. In those at the edge
    // values fall to the lowest, unless a cut takes them off.
    for (const char* look : {"suggested", "ramp", "opaque", "opaque and cut"}) {
        const auto scene = readVolume(path("hole.nc"));
        ASSERT_TRUE(scene.ok()) << scene.status.text;
        const std::string text = look;
        const osg::ref_ptr<Voxels> voxels = (*scene)->getVoxels();
        if (text != "suggested") {
            const osg::ref_ptr<LookupTable> table = new LookupTable;
            if (text != "ramp") {
                ASSERT_TRUE(table->setEntries({{1, 1, 1, 1}, {1, 1, 1, 1}}));
            }
            (*scene)->setLookupTable(table);
        }
        if (text == "opaque and cut") {
            (*scene)->setCut(new VolumeCut);
            ASSERT_TRUE((*scene)->getCut()->addRegion(
                CutRegion::mask(voxels, voxels->getRange().x(), voxels->getRange().y())));
        }
        const support::FloatImage image = support::renderScene(*scene, view);
        double filled = 0.0, hole = 0.0;
        for (int y = 8; y < 56; ++y)
            for (int x = 8; x < 56; ++x) {
                if (x < 23) filled = std::max(filled, double(image.at(x, y)[3]));
                if (x > 27) hole = std::max(hole, double(image.at(x, y)[3]));
            }
        EXPECT_GT(filled, 0.05) << look;
        EXPECT_EQ(hole, 0.0) << look;
    }
}

} // namespace GdalTest

#endif
