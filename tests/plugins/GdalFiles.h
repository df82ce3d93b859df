#pragma once

#include <osgVolumizer/ReadVoxels.h>

#include <support/FolderTest.h>

#include <gtest/gtest.h>

#include <gdal_priv.h>

#include <memory>
#include <string>
#include <vector>

/// A multidimensional file that a test writes with GDAL: "netCDF" or "Zarr".
class GdalWriter
{
public:
    using Dimension = std::shared_ptr<GDALDimension>;
    using Array = std::shared_ptr<GDALMDArray>;
    using Group = std::shared_ptr<GDALGroup>;

    GdalWriter(const std::string& path, const char* driver, const char* option = nullptr)
        : _isNetCdf(std::string(driver) == "netCDF")
    {
        GDALAllRegister();
        const char* const options[] = {option, nullptr};
        GDALDriver* const writer = GetGDALDriverManager()->GetDriverByName(driver);
        EXPECT_TRUE(writer) << driver;
        if (writer) _dataset.reset(writer->CreateMultiDimensional(path.c_str(), nullptr, options));
        EXPECT_TRUE(_dataset) << path;
        if (_dataset) _root = _dataset->GetRootGroup();
    }

    const Group& root() const { return _root; }
    /// With coordinates of that name, where there are any.
    Dimension dimension(const std::string& name, GUInt64 size, const std::vector<double>& at = {},
                        const std::string& unit = {}, GDALDataType type = GDT_Float64,
                        const std::string& positive = {})
    {
        Dimension d = _root->CreateDimension(name, "", "", size);
        EXPECT_TRUE(d) << name;
        if (at.empty()) return d;
        const Array array = this->array<double>(_root, name, {d}, at, type);
        if (!unit.empty()) array->SetUnit(unit);
        if (!positive.empty()) text(array, "positive", positive);
        if (!_isNetCdf) { // there the name says it
            EXPECT_TRUE(d->SetIndexingVariable(array));
        }
        _coordinates.push_back(array);
        return d;
    }
    /// Not written where there are no values.
    template <class T>
    Array array(const Group& group, const std::string& name, const std::vector<Dimension>& sizes,
                const std::vector<T>& values, GDALDataType type,
                const std::vector<std::pair<std::string, double>>& attributes = {})
    {
        const Array array = group->CreateMDArray(name, sizes, GDALExtendedDataType::Create(type));
        EXPECT_TRUE(array) << name;
        if (!array) return array;
        for (const auto& [key, value] : attributes)
            number(array, key, value);
        if (!values.empty()) write(array, values);
        return array;
    }
    template <class T>
    static void write(const Array& array, const std::vector<T>& values)
    {
        std::vector<GUInt64> start;
        std::vector<size_t> count;
        for (const Dimension& d : array->GetDimensions()) {
            start.push_back(0);
            count.push_back(d->GetSize());
        }
        EXPECT_TRUE(array->Write(start.data(), count.data(), nullptr, nullptr,
                                 GDALExtendedDataType::Create(gdalType<T>()), values.data()));
    }
    static void text(const Array& array, const std::string& name, const std::string& value)
    {
        const auto a = array->CreateAttribute(name, {}, GDALExtendedDataType::CreateString());
        EXPECT_TRUE(a && a->Write(value.c_str())) << name;
    }
    /// Of the array's type, as the conventions want; scale and offset are doubles.
    static void number(const Array& array, const std::string& name, double value)
    {
        if (name == "_FillValue") {
            EXPECT_TRUE(array->SetNoDataValue(value));
            return;
        }
        if (name == "scale_factor") {
            EXPECT_TRUE(array->SetScale(value, GDT_Float64));
            return;
        }
        if (name == "add_offset") {
            EXPECT_TRUE(array->SetOffset(value, GDT_Float64));
            return;
        }
        const auto a = array->CreateAttribute(name, {}, array->GetDataType());
        EXPECT_TRUE(a && a->Write(value)) << name;
    }

private:
    template <class T>
    static GDALDataType gdalType()
    {
        if (std::is_same<T, float>()) return GDT_Float32;
        if (std::is_same<T, double>()) return GDT_Float64;
        if (std::is_same<T, std::int16_t>()) return GDT_Int16;
        if (std::is_same<T, std::int32_t>()) return GDT_Int32;
        if (std::is_same<T, std::int64_t>()) return GDT_Int64;
        return GDT_Byte;
    }
    struct Close
    {
        void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
    };

    bool _isNetCdf;
    std::unique_ptr<GDALDataset, Close> _dataset;
    Group _root;
    std::vector<Array> _coordinates; // before the file is closed
};

class GdalFolderTest : public osgVolumizer::support::FolderTest
{
protected:
    using Source = osgVolumizer::VoxelSource;

    osgVolumizer::Result<osg::ref_ptr<osgVolumizer::Voxels>>
    read(const std::string& name, const std::string& options = {}) const
    {
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        return osgVolumizer::readVoxels(path(name), o.get());
    }
    /// Null where it cannot be read, which is a failure of the test.
    osg::ref_ptr<Source> open(const std::string& name, const std::string& options = {}) const
    {
        const auto voxels = read(name, options);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getSource() : nullptr;
    }
    /// A value that tells samples and steps apart.
    static int value(int x, int y, int z, int step = 0)
    {
        return (3 * x + 7 * y + 31 * z + 101 * step) % 251;
    }
    template <class T>
    static std::vector<T> volume(int width, int height, int depth, int steps = 1)
    {
        std::vector<T> values;
        for (int t = 0; t < steps; ++t)
            for (int z = 0; z < depth; ++z)
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)
                        values.push_back(static_cast<T>(value(x, y, z, t)));
        return values;
    }
    template <class T>
    static std::vector<T> samples(const Source& source, const osgVolumizer::core::Box3i& region,
                                  int level = 0, int step = 0)
    {
        const glm::ivec3 size = region.size();
        std::vector<T> values(std::size_t(size.x) * size.y * size.z);
        const osgVolumizer::Status status = source.readStep(step, level, region, values.data());
        EXPECT_TRUE(status.ok()) << status.text;
        return values;
    }
    template <class T>
    static std::vector<T> all(const Source& source, int step = 0)
    {
        return samples<T>(source, {glm::ivec3(0), source.describe().size}, 0, step);
    }
};
