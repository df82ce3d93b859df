#pragma once

#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <support/FolderTest.h>

#include <osg/Notify>

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

/// Base of the tests of VTK's volumes: what is told is collected.
class VtkFolderTest : public osgVolumizer::support::FolderTest
{
protected:
    using Source = osg::ref_ptr<const osgVolumizer::VoxelSource>;

    void SetUp() override
    {
        FolderTest::SetUp();
        _before = osg::getNotifyHandler();
        _told = new Told;
        osg::setNotifyHandler(_told);
    }
    void TearDown() override
    {
        osg::setNotifyHandler(_before);
        FolderTest::TearDown();
    }

    /// All that was told so far.
    const std::string& told() const { return _told->text; }
    void forgetTold() { _told->text.clear(); }

    static osgVolumizer::Result<osg::ref_ptr<osgVolumizer::Voxels>>
    readWith(const std::string& file, const std::string& options)
    {
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        return osgVolumizer::readVoxels(file, o);
    }
    /// Null, and a failure, where it cannot be opened.
    static Source open(const std::string& file, const std::string& options = "")
    {
        const auto voxels = readWith(file, options);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getSource() : nullptr;
    }
    /// All samples of a step, whatever their type.
    static std::vector<double> valuesOf(const osgVolumizer::VoxelSource& source, int step = 0)
    {
        using namespace osgVolumizer;
        const VoxelSource::Description d = source.describe();
        std::vector<unsigned char> bytes(static_cast<std::size_t>(d.sizeInBytes()));
        const Status status = source.readStep(step, 0, {glm::ivec3(0), d.size}, bytes.data());
        EXPECT_TRUE(status.ok()) << status.text;
        std::vector<double> values(bytes.size() / voxelTypeSize(d.type));
        core::convertVoxels(bytes.data(), d.type, values.data(), VoxelType::FLOAT64, values.size());
        return values;
    }
    static std::vector<double> valuesOf(const Source& source)
    {
        return source ? valuesOf(*source) : std::vector<double>();
    }
    static std::string refusal(const std::string& file, const std::string& options,
                               osgVolumizer::ErrorCode code)
    {
        const auto voxels = readWith(file, options);
        EXPECT_FALSE(voxels.ok()) << file;
        EXPECT_EQ(voxels.status.code, code) << voxels.status.text;
        EXPECT_EQ(voxels.status.text.find('\n'), std::string::npos) << voxels.status.text;
        EXPECT_EQ(voxels.status.text.rfind(file, 0), 0u) << voxels.status.text;
        return voxels.status.text;
    }
    static std::string contentOf(const std::string& file)
    {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    /// Of `size` points, in object units.
    static vtkSmartPointer<vtkImageData> image(int x, int y, int z)
    {
        const auto set = vtkSmartPointer<vtkImageData>::New();
        set->SetDimensions(x, y, z);
        return set;
    }
    template <class Array, class Number>
    static void addArray(vtkDataSetAttributes* data, const char* name, int components,
                         const std::vector<Number>& values)
    {
        vtkNew<Array> array;
        array->SetName(name);
        array->SetNumberOfComponents(components);
        for (const Number v : values)
            array->InsertNextValue(v);
        data->AddArray(array);
    }
    template <class Writer, class Set>
    std::string write(const std::string& name, Set* set, int mode = vtkXMLWriter::Ascii,
                      int compressor = vtkXMLWriter::NONE, bool encoded = true) const
    {
        vtkNew<Writer> writer;
        writer->SetFileName(path(name).c_str());
        writer->SetInputData(set);
        writer->SetDataMode(mode);
        writer->SetCompressorType(compressor);
        writer->SetEncodeAppendedData(encoded);
        EXPECT_TRUE(writer->Write());
        return path(name);
    }
    std::string writeImage(const std::string& name, vtkImageData* set,
                           int mode = vtkXMLWriter::Ascii, int compressor = vtkXMLWriter::NONE,
                           bool encoded = true) const
    {
        return write<vtkXMLImageDataWriter>(name, set, mode, compressor, encoded);
    }
    std::string writeGrid(const std::string& name, vtkRectilinearGrid* set) const
    {
        return write<vtkXMLRectilinearGridWriter>(name, set);
    }

private:
    struct Told : osg::NotifyHandler
    {
        void notify(osg::NotifySeverity severity, const char* message) override
        {
            if (severity <= osg::NOTICE) text += message;
        }
        std::string text;
    };
    osg::ref_ptr<osg::NotifyHandler> _before;
    osg::ref_ptr<Told> _told;
};
