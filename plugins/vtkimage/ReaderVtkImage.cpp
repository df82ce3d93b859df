// Images and rectilinear grids of VTK for readVoxels(): see osgVolumizer/io/FormatPlugin.h.

#include "DataSetFile.h"
#include "Lattice.h"
#include "Resample.h"
#include "Samples.h"

#include <osgVolumizer/VoxelSeries.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/io/FormatPlugin.h>
#include <osgVolumizer/io/Placement.h>
#include <osgVolumizer/io/PluginFile.h>

#include <osg/Notify>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgVolumizer {
namespace vtkimage {
namespace {

void tell(const std::string& path, const std::string& text)
{
    OSG_NOTICE << "osgVolumizer: " << path << ": " << text << std::endl;
}

Status inFile(const std::string& path, const Status& status)
{
    return {status.code, path + ": " + status.text, status.index};
}

std::string percentOf(double part, double whole)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g%%", whole > 0.0 ? 100.0 * part / whole : 0.0);
    return text;
}

// Of a sample when it is resampled.
std::size_t bytesOf(const Samples& samples)
{
    return samples.type() == VoxelType::FLOAT64 ? sizeof(double) : sizeof(float);
}

/// An array of a data set that was read; `quiet` where it was told before what it is.
Result<osg::ref_ptr<MemoryVoxelSource>> makeVoxels(vtkDataSet& set, const FileHead& head,
                                                   const ArrayInfo& array,
                                                   const io::VolumeRequest& request, bool quiet)
{
    const std::string& path = request.path;
    const Result<Lattice> lattice = latticeOf(set, array.cells);
    if (!lattice.ok()) return inFile(path, lattice.status);
    const Result<Samples> samples = Samples::of(set, head, array, request.channel);
    if (!samples.ok()) return inFile(path, samples.status);
    if (!quiet && !samples->notice().empty()) tell(path, samples->notice());
    const Lattice even = lattice->isEven() ? *lattice : evenLattice(*lattice, bytesOf(*samples));
    VoxelSource::Description description;
    if (Status status = io::place(description, even.steps, even.position); !status.ok())
        return inFile(path, status);
    description.size = lattice->size;
    auto voxels = samples->voxels(description);
    if (!voxels.ok()) return inFile(path, voxels.status);
    if (lattice->isEven()) return voxels;
    double error = 0.0;
    voxels = resample(**voxels, *lattice, even, error);
    if (!voxels.ok()) return inFile(path, voxels.status);
    const double range =
        samples->components() == 4 ? 255.0 : samples->range().high - samples->range().low;
    if (!quiet)
        tell(path, "the samples are unevenly spaced, and are resampled from " +
                       core::formatTriple(lattice->size) + " to " + core::formatTriple(even.size) +
                       " even ones; at the old places the new ones are wrong by at most " +
                       percentOf(error, range) + " of the range");
    return voxels;
}

Result<osg::ref_ptr<VoxelSource>> readStep(const io::VolumeRequest& request, const FileHead& head,
                                           const ArrayInfo& array, int step)
{
    const auto set = readDataSet(request.path, head, &array, step);
    if (!set.ok()) return set.status;
    const auto voxels = makeVoxels(**set, head, array, request, step > 0);
    if (!voxels.ok()) return voxels.status;
    return osg::ref_ptr<VoxelSource>(voxels->get());
}

class ReaderVtkImage : public io::FormatPlugin
{
public:
    ReaderVtkImage() : FormatPlugin("osgvolumizer_vtk", "Volumes of VTK for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer VTK image reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        const Result<FileHead> head = readHead(request.path);
        if (!head.ok()) return head.status;
        const Result<ArrayInfo> array = head->choose(request.dataset);
        if (!array.ok()) return inFile(request.path, array.status);
        if (head->steps == 1) return readStep(request, *head, *array, 0);
        osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
        const CallerReports quiet;
        Status status =
            series->setSteps(head->steps, [request, head = *head, array = *array](int step) {
                return readStep(request, head, array, step);
            });
        if (!status.ok()) return status;
        return io::Source(series);
    }

    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        const Result<FileHead> head = readHead(request.path);
        if (!head.ok()) return head.status;
        const Result<ArrayInfo> chosen = head->choose(request.dataset);
        if (!chosen.ok()) return inFile(request.path, chosen.status);
        const auto set = readDataSet(request.path, *head, nullptr, 0);
        if (!set.ok()) return set.status;
        std::vector<VolumeEntry> entries;
        for (const ArrayInfo& array : head->arrays) {
            const Result<VolumeEntry> entry = entryOf(**set, *head, array, request);
            if (!entry.ok()) return entry.status;
            entries.push_back(*entry);
            entries.back().name = head->nameOf(array);
            entries.back().steps = head->steps;
            entries.back().chosen = array.name == chosen->name && array.cells == chosen->cells;
        }
        return entries;
    }

private:
    static Result<VolumeEntry> entryOf(vtkDataSet& set, const FileHead& head,
                                       const ArrayInfo& array, const io::VolumeRequest& request)
    {
        const Result<Lattice> lattice = latticeOf(set, array.cells);
        if (!lattice.ok()) return inFile(request.path, lattice.status);
        // A channel is the chosen array's.
        const bool has = request.channel && *request.channel < array.components;
        const Result<Samples> samples =
            Samples::of(set, head, array, has ? request.channel : std::nullopt);
        if (!samples.ok()) return inFile(request.path, samples.status);
        const glm::ivec3 size =
            lattice->isEven() ? lattice->size : evenLattice(*lattice, bytesOf(*samples)).size;
        VolumeEntry entry;
        entry.size = {size.x, size.y, size.z};
        entry.type = samples->type();
        if (!lattice->isEven() && samples->components() == 1 && entry.type != VoxelType::FLOAT64)
            entry.type = VoxelType::FLOAT32;
        entry.channels = array.components;
        entry.text = std::string(array.cells ? "cells" : "points");
        if (!samples->range().empty())
            entry.text += ", from " + core::formatNumber(samples->range().low) + " to " +
                          core::formatNumber(samples->range().high);
        if (!lattice->isEven())
            entry.text += ", resampled from " + core::formatTriple(lattice->size);
        return entry;
    }
};

} // namespace
} // namespace vtkimage
} // namespace osgVolumizer

using osgVolumizer::vtkimage::ReaderVtkImage;
REGISTER_OSGPLUGIN(osgvolumizer_vtk, ReaderVtkImage)
