#include "DicomVolume.h"

#include "DicomPixels.h"
#include "DicomSeries.h"

#include <osgVolumizer/VoxelSeries.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/io/FileKind.h>
#include <osgVolumizer/io/NarrowestType.h>
#include <osgVolumizer/io/Placement.h>

#include <gdcmTrace.h>

#include <osg/Notify>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

namespace osgVolumizer {
namespace medical {

namespace {

using Memory = osg::ref_ptr<MemoryVoxelSource>;

struct Chosen
{
    DicomStudy study;
    std::size_t series = 0;
    DicomGrid grid;

    const DicomSeries& theSeries() const { return study.series[series]; }
    const DicomFile& fileOf(const DicomFrame& f) const { return study.files[std::size_t(f.file)]; }
    const DicomFile& like() const { return fileOf(theSeries().frames.front()); }
};

std::vector<std::string> filesOf(const io::VolumeRequest& request)
{
    return request.files.empty() ? std::vector<std::string>{request.path} : request.files;
}

/// The least and most that a frame can hold by what its header says; whether in whole numbers.
bool claimOf(const DicomFile& file, const DicomFrame& frame, core::ValueRange& range)
{
    if (file.isFloat) return false;
    if (!file.lut.empty()) {
        const auto ends = std::minmax_element(file.lut.begin(), file.lut.end());
        range.expand({*ends.first, *ends.second});
        return true;
    }
    if (file.colour()) {
        const int bits = file.palette[0].empty() ? file.stored : file.paletteBits;
        range.expand({0.0, std::ldexp(1.0, bits) - 1.0});
        return true;
    }
    const double low = file.isSigned ? -std::ldexp(1.0, file.stored - 1) : 0.0;
    const double high = low + std::ldexp(1.0, file.stored) - 1.0;
    const double a = frame.slope * low + frame.intercept, b = frame.slope * high + frame.intercept;
    range.expand({std::min(a, b), std::max(a, b)});
    return frame.slope == std::round(frame.slope) && frame.intercept == std::round(frame.intercept);
}

VoxelType typeOf(const Chosen& chosen)
{
    core::ValueRange range;
    bool whole = true;
    for (const auto& step : chosen.grid.steps)
        for (const DicomFrame& frame : step)
            whole = claimOf(chosen.fileOf(frame), frame, range) && whole;
    return whole ? io::narrowestInteger(range, VoxelType::FLOAT32) : VoxelType::FLOAT32;
}

Result<VoxelSource::Description> describe(const Chosen& chosen)
{
    VoxelSource::Description d;
    const DicomGrid& grid = chosen.grid;
    d.size = {chosen.theSeries().columns, chosen.theSeries().rows, int(grid.slices.size())};
    d.type = typeOf(chosen);
    const glm::dmat3 steps(grid.axes[0], grid.axes[1], grid.axes[2]);
    if (Status status = io::place(d, steps, grid.placed ? grid.position : glm::dvec3(0.0));
        !status.ok())
        return status;
    return d;
}

/// Reads whole files, one after the other, into the slices that are theirs.
class SliceReader
{
public:
    SliceReader(const Chosen& chosen, int channel) : _chosen(chosen), _channel(channel) {}

    Status read(const VoxelSource::Description& d, std::vector<Memory>& steps)
    {
        const DicomGrid& grid = _chosen.grid;
        VoxelSource::Description slices = d;
        slices.size.z = static_cast<int>(grid.steps.front().size());
        std::map<int, std::vector<Target>> byFile;
        const bool layered = !grid.over.empty();
        const CallerReports quiet;
        for (std::size_t s = 0; s < grid.steps.size(); ++s) {
            steps.push_back(new MemoryVoxelSource);
            if (Status status = steps.back()->allocate(slices); !status.ok()) return status;
            if (layered) std::memset(steps.back()->data(), 0, std::size_t(slices.sizeInBytes()));
            for (std::size_t k = 0; k < grid.steps[s].size(); ++k)
                byFile[grid.steps[s][k].file].push_back(
                    {steps.back().get(), k, grid.steps[s][k], layered});
        }
        for (const DicomGrid::Over& over : grid.over)
            byFile[over.frame.file].push_back({steps[0].get(), over.slice, over.frame, true});
        for (const auto& [file, targets] : byFile)
            if (Status status = readFile(_chosen.study.files[std::size_t(file)], targets, d.type);
                !status.ok())
                return status;
        fillPadding(d.type);
        return {};
    }
    const core::ValueRange& range() const { return _range; }

private:
    struct Target
    {
        MemoryVoxelSource* volume;
        std::size_t slice;
        DicomFrame frame;
        bool over = false; ///< only what is not 0, on what is there
    };
    /// Samples of padding, of a type that has no mark for them.
    struct Gap
    {
        MemoryVoxelSource* volume;
        std::size_t first, count;
    };

    Status readFile(const DicomFile& file, const std::vector<Target>& targets, VoxelType type)
    {
        DicomPixels pixels;
        if (Status status = pixels.open(file); !status.ok()) return status;
        for (const Target& target : targets) {
            if (Status status = pixels.readFrame(file, target.frame, _channel, _values);
                !status.ok())
                return status;
            if (file.padding) rememberPadding(target);
            for (const double v : _values)
                _range.expand({v, v});
            store(target, type);
        }
        return {};
    }
    void store(const Target& target, VoxelType type)
    {
        const std::size_t bytes = _values.size() * voxelTypeSize(type);
        char* to = static_cast<char*>(target.volume->data()) + target.slice * bytes;
        if (!target.over) {
            core::convertVoxels(_values.data(), VoxelType::FLOAT64, to, type, _values.size());
            return;
        }
        for (std::size_t i = 0; i < _values.size(); ++i)
            if (_values[i] != 0.0)
                core::convertVoxels(&_values[i], VoxelType::FLOAT64, to + i * voxelTypeSize(type),
                                    type, 1);
    }
    void rememberPadding(const Target& target)
    {
        const std::size_t first = target.slice * _values.size();
        for (std::size_t i = 0, end = 0; i < _values.size(); i = end + 1) {
            for (end = i; end < _values.size() && std::isnan(_values[end]);)
                ++end;
            if (end > i) _padding.push_back({target.volume, first + i, end - i});
        }
    }
    // The lowest of what is no padding: nothing is below it.
    void fillPadding(VoxelType type)
    {
        const double lowest = _range.empty() ? 0.0 : _range.low;
        if (!_padding.empty()) _range.expand({lowest, lowest});
        for (const Gap& gap : _padding) {
            _values.assign(gap.count, lowest);
            core::convertVoxels(_values.data(), VoxelType::FLOAT64,
                                static_cast<char*>(gap.volume->data()) +
                                    gap.first * voxelTypeSize(type),
                                type, gap.count);
        }
    }

    const Chosen& _chosen;
    int _channel;
    std::vector<double> _values;
    std::vector<Gap> _padding;
    core::ValueRange _range;
};

/// Slices where they belong, in the type of `d`.
Result<Memory> resample(const MemoryVoxelSource& from, const DicomGrid& grid,
                        const VoxelSource::Description& d)
{
    Memory to = new MemoryVoxelSource;
    const CallerReports quiet;
    if (Status status = to->allocate(d); !status.ok()) return status;
    const std::size_t count = std::size_t(d.size.x) * std::size_t(d.size.y);
    const VoxelType source = from.describe().type;
    const auto* data = static_cast<const char*>(from.data());
    std::vector<double> a(count), b(count);
    for (std::size_t k = 0; k < grid.slices.size(); ++k) {
        const DicomGrid::Slice& slice = grid.slices[k];
        const std::size_t bytes = count * voxelTypeSize(source);
        char* target = static_cast<char*>(to->data()) + k * count * voxelTypeSize(d.type);
        if (slice.empty) {
            std::memset(target, 0, count * voxelTypeSize(d.type));
            continue;
        }
        if (slice.weight == 0.0) {
            core::convertVoxels(data + slice.lower * bytes, source, target, d.type, count);
            continue;
        }
        core::convertVoxels(data + slice.lower * bytes, source, a.data(), VoxelType::FLOAT64,
                            count);
        core::convertVoxels(data + (slice.lower + 1) * bytes, source, b.data(), VoxelType::FLOAT64,
                            count);
        for (std::size_t i = 0; i < count; ++i)
            a[i] += slice.weight * (b[i] - a[i]);
        core::convertVoxels(a.data(), VoxelType::FLOAT64, target, d.type, count);
    }
    return to;
}

// Whether each slice is one that was read.
bool isAsItIs(const DicomGrid& grid)
{
    if (grid.slices.size() != grid.steps.front().size()) return false;
    for (std::size_t k = 0; k < grid.slices.size(); ++k)
        if (grid.slices[k].lower != k || grid.slices[k].weight != 0.0 || grid.slices[k].empty)
            return false;
    return true;
}

void notice(const std::string& path, const std::string& text)
{
    OSG_NOTICE << "osgVolumizer: " << path << ": " << text << std::endl;
}

// What is made of the files, and what is not.
void tell(const io::VolumeRequest& request, const Chosen& chosen)
{
    const DicomStudy& study = chosen.study;
    const DicomSeries& series = chosen.theSeries();
    const std::string named =
        (series.description.empty() ? "" : "\"" + series.description + "\" ") + "(" + series.uid +
        ")";
    const bool several = study.series.size() > std::size_t(series.parts);
    if (several && request.dataset.empty())
        notice(request.path,
               "of " + std::to_string(study.series.size()) + " series the largest is taken, " +
                   std::to_string(chosen.series + 1) + " " + named + "; dataset= chooses another");
    std::int64_t number = 0;
    if (series.parts > 1 && !core::parseInteger(request.dataset, number))
        notice(request.path, "of " + std::to_string(series.parts) +
                                 " volumes that lie beside each other in this series, as stations "
                                 "or tiles do, the largest is taken, " +
                                 std::to_string(chosen.series + 1) + "; dataset= chooses another");
    if (study.copies > 0)
        notice(request.path,
               std::to_string(study.copies) + " files are copies of others and are left out");
    if (series.setAside > 0)
        notice(request.path, std::to_string(series.setAside) +
                                 " pictures of another size or orientation, such as scouts, are "
                                 "set aside");
    if (study.unread > 0)
        notice(request.path, std::to_string(study.unread) +
                                 " files are left out, the first of them since " +
                                 study.firstReason);
    for (const std::string& text : chosen.grid.notices)
        notice(request.path, text);
    if (!chosen.like().note.empty()) notice(request.path, chosen.like().note);
}

// Whether a UID stands in the first elements of a file: much faster than to parse it.
bool beginsWithSeries(const std::string& path, const std::string& uid)
{
    std::string head(std::size_t(16) << 10, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    for (std::size_t at = head.find(uid); at != std::string::npos; at = head.find(uid, at + 1)) {
        const std::size_t end = at + uid.size();
        if (end >= head.size() ||
            (head[end] != '.' && !std::isdigit(static_cast<unsigned char>(head[end]))))
            return true;
    }
    return false;
}

// A file of one slice that is opened by its own name, where its series is in the folder.
void tellOfFolder(const std::string& path, const DicomFile& file)
{
    namespace fs = std::filesystem;
    constexpr int MOST_LOOKED_AT = 64;
    if (file.series.empty() || file.frames.size() > 1) return;
    int count = 0;
    std::error_code failed;
    for (fs::directory_iterator i(fs::absolute(path).parent_path(), failed), end;
         !failed && i != end && count < MOST_LOOKED_AT; i.increment(failed)) {
        const std::string other = i->path().string();
        if (i->path().filename() == fs::path(path).filename() ||
            io::fileKindOf(other) != io::FileKind::DICOM)
            continue;
        ++count;
        if (!beginsWithSeries(other, file.series)) continue;
        notice(path, "is one slice of a series; open its folder for all of it");
        return;
    }
}

Result<Chosen> choose(const io::VolumeRequest& request)
{
    static const bool quiet =
        (gdcm::Trace::WarningOff(), gdcm::Trace::ErrorOff(), gdcm::Trace::DebugOff(), true);
    (void)quiet;
    Chosen chosen;
    Result<DicomStudy> study = readDicomStudy(filesOf(request));
    if (!study.ok()) return study.status;
    chosen.study = std::move(*study);
    const Result<std::size_t> series = chooseSeries(chosen.study, request.dataset);
    if (!series.ok()) return Status(series.status.code, request.path + ": " + series.status.text);
    chosen.series = *series;
    chosen.grid = layOut(chosen.theSeries(), chosen.like());
    return chosen;
}

Result<int> channelOf(const io::VolumeRequest& request, const DicomFile& file)
{
    if (!request.channel) return int(DicomPixels::LUMINANCE);
    const int channels = file.photometric == "PALETTE COLOR" ? 3 : file.samples;
    if (*request.channel < channels)
        return file.colour() ? *request.channel : int(DicomPixels::LUMINANCE);
    return Status(ErrorCode::INDEX_OUT_OF_RANGE, request.path + " has no channel " +
                                                     std::to_string(*request.channel) + ", but " +
                                                     std::to_string(channels) + ", from 0 on");
}

// What the type of the values can be made, once they are known: not below 16 bits.
VoxelType narrowed(VoxelType type, const core::ValueRange& range)
{
    if (type != VoxelType::INT32 && type != VoxelType::UINT32) return type;
    const VoxelType least = io::narrowestInteger(range, VoxelType::FLOAT32);
    if (voxelTypeSize(least) > 2) return least;
    return range.low < 0.0 || least == VoxelType::INT8 ? VoxelType::INT16 : VoxelType::UINT16;
}

} // namespace

Result<io::Source> readDicom(const io::VolumeRequest& request)
{
    const Result<Chosen> chosen = choose(request);
    if (!chosen.ok()) return chosen.status;
    const Result<int> channel = channelOf(request, chosen->like());
    if (!channel.ok()) return channel.status;
    const Result<VoxelSource::Description> d = describe(*chosen);
    if (!d.ok()) return Status(d.status.code, request.path + ": " + d.status.text);
    SliceReader reader(*chosen, *channel);
    std::vector<Memory> steps;
    if (Status status = reader.read(*d, steps); !status.ok()) return status;
    VoxelSource::Description as = *d;
    as.type = narrowed(d->type, reader.range());
    std::vector<osg::ref_ptr<VoxelSource>> sources;
    const bool asTheyAre = as.type == d->type && isAsItIs(chosen->grid);
    for (Memory& step : steps) {
        if (!asTheyAre) {
            const Result<Memory> even = resample(*step, chosen->grid, as);
            if (!even.ok()) return Status(even.status.code, request.path + ": " + even.status.text);
            step = *even;
        }
        sources.push_back(step.get());
    }
    tell(request, *chosen);
    if (request.files.empty()) tellOfFolder(request.path, chosen->like());
    if (sources.size() == 1) return io::Source(sources.front());
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    Status status = series->setSteps(sources);
    if (!status.ok()) return Status(status.code, request.path + ": " + status.text);
    return io::Source(series.get());
}

Result<std::vector<VolumeEntry>> listDicom(const io::VolumeRequest& request)
{
    Result<Chosen> chosen = choose(request);
    if (!chosen.ok()) return chosen.status;
    const std::size_t wanted = chosen->series;
    std::vector<VolumeEntry> entries;
    for (std::size_t i = 0; i < chosen->study.series.size(); ++i) {
        chosen->series = i;
        chosen->grid = layOut(chosen->theSeries(), chosen->like());
        const DicomSeries& series = chosen->theSeries();
        const DicomGrid& grid = chosen->grid;
        VolumeEntry entry;
        entry.name = std::to_string(i + 1);
        entry.size = {series.columns, series.rows, int(grid.slices.size())};
        entry.type = typeOf(*chosen);
        entry.channels = chosen->like().photometric == "PALETTE COLOR" ? 3 : chosen->like().samples;
        entry.steps = static_cast<int>(grid.steps.size());
        entry.chosen = i == wanted;
        entry.text =
            series.modality + (series.description.empty() ? "" : ", " + series.description) + ", " +
            std::to_string(grid.steps.front().size()) + " slices of " +
            core::formatTriple(glm::dvec3(glm::length(grid.axes[0]), glm::length(grid.axes[1]),
                                          glm::length(grid.axes[2]))) +
            " mm, " + series.uid +
            (series.parts > 1
                 ? ", part " + std::to_string(series.part) + " of " + std::to_string(series.parts)
                 : "");
        entries.push_back(entry);
    }
    return entries;
}

} // namespace medical
} // namespace osgVolumizer
