#pragma once

#include "Dataset.h"

#include <osgVolumizer/VoxelSource.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace hdf5 {

/// What of a file is to be read.
struct Wanted
{
    std::string dataset;        ///< path; empty: not said
    std::optional<int> channel; ///< of Imaris, or setup of BigDataViewer
};

/// A copy of the volume as it is in a file.
struct FileLevel
{
    glm::ivec3 size{0};
    glm::ivec3 halvings{0}; ///< per axis, to come from the volume to this
};

/// Where the voxels of a file are.
struct Layout
{
    VoxelSource::Description description;
    VoxelType readAs = VoxelType::UINT8; ///< as the library converts them; of the same size
    std::vector<FileLevel> levels;       ///< the volume first
    int steps = 1;
    int channels = 1;
    Axes axes; ///< of all datasets
    std::function<std::string(int step, int fileLevel)> pathOf;
    std::vector<std::string> notices; ///< what a user may not expect, sentences without the file

    /// The coarsest of `levels` that level `level` of core::BrickTree can be thinned out from.
    int fileLevelFor(int level) const;
};

/// Imaris 5.5: /DataSet/ResolutionLevel L/TimePoint T/Channel C/Data.
bool isImaris(hid_t file);
Result<Layout> imarisLayout(hid_t file, const Wanted& wanted);
/// BigDataViewer: /tTTTTT/sSS/L/cells.
bool isBigDataViewer(hid_t file);
Result<Layout> bigDataViewerLayout(hid_t file, const Wanted& wanted);
/// Any other: a dataset, the one wanted or the largest that is a volume.
Result<Layout> datasetLayout(hid_t file, const Wanted& wanted);
/// All datasets that are volumes. Expects a Session.
Result<std::vector<Dataset>> volumesOf(hid_t file);
/// Whichever it is. Texts of failures lack the name of the file. Expects a Session.
Result<Layout> findLayout(hid_t file, const Wanted& wanted);

/// How often an axis of `whole` samples was halved to have `size`, odd numbers rounded either way;
/// -1 where that is not how it came to be.
int halvingsOf(int whole, int size);
/// The layout of a volume in `dataset`, with its spacing, and nothing else yet.
Result<Layout> layoutOf(hid_t file, const Dataset& dataset);
/// Adds a level of the file, by its number, or a notice that it is not used.
void addLevel(int number, const FileLevel& level, Layout& layout, std::vector<int>& numbers);
/// Refuses channel `wanted` of those that are there.
Status checkChannel(const char* what, const std::vector<int>& present, int wanted);

} // namespace hdf5
} // namespace osgVolumizer
