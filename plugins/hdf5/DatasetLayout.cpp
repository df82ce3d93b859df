#include "Layout.h"

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace hdf5 {

namespace {

// The end of a sentence about a file, with the first datasets of it.
std::string listOf(const std::vector<Dataset>& datasets)
{
    constexpr std::size_t MOST = 5;
    if (datasets.empty()) return "there are no datasets at all";
    std::string text = "there is ";
    for (std::size_t i = 0; i < std::min(datasets.size(), MOST); ++i)
        text += (i ? ", " : "") + datasets[i].text();
    if (datasets.size() > MOST) text += ", and " + std::to_string(datasets.size() - MOST) + " more";
    return text;
}

double sampleCountOf(const Dataset& dataset)
{
    double count = 1.0;
    for (const hsize_t n : dataset.size)
        count *= static_cast<double>(n);
    return count;
}

bool isVolume(const Dataset& dataset)
{
    return checkVolume(dataset).ok() && voxelSize(dataset, axesOf(dataset)->z).ok();
}

// The path of the largest volume.
Result<std::string> findLargest(hid_t file)
{
    const Result<std::vector<Dataset>> datasets = listDatasets(file);
    if (!datasets.ok()) return datasets.status;
    const Dataset* largest = nullptr;
    for (const Dataset& dataset : *datasets) {
        if (!isVolume(dataset)) continue;
        if (!largest || sampleCountOf(dataset) > sampleCountOf(*largest)) largest = &dataset;
    }
    if (largest) return largest->path;
    return Status(ErrorCode::FILE_UNREADABLE,
                  "no dataset is a volume of numbers with the axes z,y,x or time,z,y,x; " +
                      listOf(*datasets));
}

Result<std::string> findNamed(hid_t file, const std::string& name)
{
    const std::string path = (name[0] == '/' ? "" : "/") + name;
    const Session session;
    const Handle id(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (id.ok()) return path;
    const std::string reason = session.reason();
    const Result<std::vector<Dataset>> datasets = listDatasets(file);
    if (!datasets.ok()) return datasets.status;
    const bool listed = std::any_of(datasets->begin(), datasets->end(),
                                    [&path](const Dataset& d) { return d.path == path; });
    if (listed)
        return Status(ErrorCode::FILE_UNREADABLE, "dataset " + path + " cannot be read" + reason);
    return Status(ErrorCode::VALUE_INVALID,
                  "there is no dataset " + path + "; " + listOf(*datasets));
}

} // namespace

Result<std::vector<Dataset>> volumesOf(hid_t file)
{
    Result<std::vector<Dataset>> datasets = listDatasets(file);
    if (!datasets.ok()) return datasets;
    datasets->erase(std::remove_if(datasets->begin(), datasets->end(),
                                   [](const Dataset& d) { return !isVolume(d); }),
                    datasets->end());
    return datasets;
}

Result<Layout> datasetLayout(hid_t file, const Wanted& wanted)
{
    if (wanted.channel)
        return Status(ErrorCode::VALUE_INVALID,
                      wanted.dataset.empty()
                          ? "option channel is for files of Imaris and BigDataViewer, and this is "
                            "neither: choose by dataset=/path"
                          : "of the options channel and dataset one excludes the other");
    const Result<std::string> path =
        wanted.dataset.empty() ? findLargest(file) : findNamed(file, wanted.dataset);
    if (!path.ok()) return path.status;
    const Result<Dataset> dataset = inspect(file, *path);
    if (!dataset.ok()) return dataset.status;
    Result<Layout> layout = layoutOf(file, *dataset);
    if (!layout.ok()) return layout;
    if (layout->axes.time >= 0) {
        const hsize_t steps = dataset->size[std::size_t(layout->axes.time)];
        if (steps == 0 || steps > hsize_t(std::numeric_limits<int>::max()))
            return Status(ErrorCode::VALUE_INVALID, "dataset " + dataset->text() + " has " +
                                                        std::to_string(steps) + " time steps");
        layout->steps = static_cast<int>(steps);
    }
    layout->pathOf = [path = *path](int, int) { return path; };
    return layout;
}

} // namespace hdf5
} // namespace osgVolumizer
