#pragma once

#include <osgVolumizer/ReadVoxels.h>

#include <support/FolderTest.h>

#include <gtest/gtest.h>

#include <hdf5.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

/// An HDF5 file that a test writes. Sizes are as HDF5 has them, slowest axis first.
class Hdf5Writer
{
public:
    using Size = std::vector<hsize_t>;

    explicit Hdf5Writer(const std::string& path)
        : _file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT))
    {
        EXPECT_GE(_file, 0) << path;
    }
    Hdf5Writer(const Hdf5Writer&) = delete;
    ~Hdf5Writer() { H5Fclose(_file); }

    hid_t id() const { return _file; }
    /// Values of `values` in memory, of `type` in the file; in pieces where `pieces` says so,
    /// packed by `filter`. Not written where there are none.
    template <class T>
    void dataset(const std::string& path, const Size& size, const std::vector<T>& values,
                 hid_t type = nativeType<T>(), const Size& pieces = {}, H5Z_filter_t filter = 0)
    {
        const hid_t space = H5Screate_simple(int(size.size()), size.data(), nullptr);
        const hid_t create = H5Pcreate(H5P_DATASET_CREATE), link = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(link, 1);
        if (!pieces.empty()) H5Pset_chunk(create, int(pieces.size()), pieces.data());
        const unsigned effort = 1;
        if (filter) H5Pset_filter(create, filter, H5Z_FLAG_MANDATORY, 1, &effort);
        const hid_t id = H5Dcreate2(_file, path.c_str(), type, space, link, create, H5P_DEFAULT);
        EXPECT_GE(id, 0) << path;
        if (!values.empty()) {
            EXPECT_GE(H5Dwrite(id, nativeType<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                      0);
        }
        H5Dclose(id);
        H5Pclose(link);
        H5Pclose(create);
        H5Sclose(space);
    }
    /// As Imaris writes text: each character a string.
    void attribute(const std::string& path, const std::string& name, const std::string& text)
    {
        const hsize_t count = text.size();
        const hid_t object = openOrCreate(path), space = H5Screate_simple(1, &count, nullptr);
        const hid_t id =
            H5Acreate2(object, name.c_str(), H5T_C_S1, space, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(H5Awrite(id, H5T_C_S1, text.data()), 0);
        H5Aclose(id);
        H5Sclose(space);
        H5Oclose(object);
    }
    void attribute(const std::string& path, const std::string& name, std::vector<double> values)
    {
        const hsize_t count = values.size();
        const hid_t object = openOrCreate(path), space = H5Screate_simple(1, &count, nullptr);
        const hid_t id =
            H5Acreate2(object, name.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(H5Awrite(id, H5T_NATIVE_DOUBLE, values.data()), 0);
        H5Aclose(id);
        H5Sclose(space);
        H5Oclose(object);
    }

    template <class T>
    static hid_t nativeType()
    {
        if (std::is_floating_point<T>())
            return sizeof(T) == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
        const bool hasSign = std::is_signed<T>();
        switch (sizeof(T)) {
        case 1:
            return hasSign ? H5T_NATIVE_INT8 : H5T_NATIVE_UINT8;
        case 2:
            return hasSign ? H5T_NATIVE_INT16 : H5T_NATIVE_UINT16;
        case 4:
            return hasSign ? H5T_NATIVE_INT32 : H5T_NATIVE_UINT32;
        default:
            return hasSign ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64;
        }
    }

private:
    hid_t openOrCreate(const std::string& path)
    {
        const hid_t link = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(link, 1);
        hid_t id = -1;
        H5E_BEGIN_TRY
        {
            id = H5Oopen(_file, path.c_str(), H5P_DEFAULT);
        }
        H5E_END_TRY
        if (id < 0) id = H5Gcreate2(_file, path.c_str(), link, H5P_DEFAULT, H5P_DEFAULT);
        H5Pclose(link);
        return id;
    }

    hid_t _file;
};

/// Base of tests of HDF5 files: nothing of the library stays open.
class Hdf5FolderTest : public osgVolumizer::support::FolderTest
{
protected:
    using Size = Hdf5Writer::Size;
    using Source = osgVolumizer::VoxelSource;

    void TearDown() override
    {
        EXPECT_EQ(H5Fget_obj_count(hid_t(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
        FolderTest::TearDown();
    }
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

    /// A value that tells samples, levels and steps apart.
    static int value(int x, int y, int z, int step = 0, int level = 0)
    {
        return (3 * x + 7 * y + 31 * z + 101 * step + 57 * level) % 251;
    }
    template <class T>
    static std::vector<T> volume(int width, int height, int depth, int step = 0, int level = 0)
    {
        std::vector<T> values;
        for (int z = 0; z < depth; ++z)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    values.push_back(static_cast<T>(value(x, y, z, step, level)));
        return values;
    }
    /// The samples of a region of a level and step.
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
};
