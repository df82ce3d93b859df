#include "DicomSeries.h"

#include <osgVolumizer/core/Text.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr double SAME_DIRECTION = 1e-3; // radians
constexpr double SAME_SPACING = 1e-3;   // of it

bool isAlike(const DicomFrame& a, const DicomFrame& b)
{
    return a.placed == b.placed && glm::distance(a.row, b.row) < SAME_DIRECTION &&
           glm::distance(a.column, b.column) < SAME_DIRECTION &&
           std::abs(a.columnStep - b.columnStep) <= SAME_SPACING * a.columnStep &&
           std::abs(a.rowStep - b.rowStep) <= SAME_SPACING * a.rowStep;
}

/// Frames that can be slices of one volume.
struct Group
{
    const DicomFile* like;
    std::vector<DicomFrame> frames;

    bool takes(const DicomFile& file, const DicomFrame& frame) const
    {
        return like->columns == file.columns && like->rows == file.rows &&
               like->colour() == file.colour() && isAlike(frames.front(), frame);
    }
    double voxels() const { return double(like->columns) * like->rows * double(frames.size()); }
};

std::vector<DicomSeries> seriesOf(const std::vector<DicomFile>& files, const std::string& uid)
{
    std::vector<Group> groups;
    int count = 0;
    for (const DicomFile& file : files) {
        if (file.series != uid) continue;
        for (const DicomFrame& frame : file.frames) {
            ++count;
            const auto group = std::find_if(groups.begin(), groups.end(),
                                            [&](const Group& g) { return g.takes(file, frame); });
            if (group == groups.end())
                groups.push_back({&file, {frame}});
            else
                group->frames.push_back(frame);
        }
    }
    const auto largest =
        std::max_element(groups.begin(), groups.end(),
                         [](const Group& a, const Group& b) { return a.voxels() < b.voxels(); });
    const DicomFile& like = *largest->like;
    DicomSeries series;
    series.uid = uid;
    series.description = like.description;
    series.modality = like.modality;
    series.number = like.seriesNumber;
    series.columns = like.columns;
    series.rows = like.rows;
    series.setAside = count - static_cast<int>(largest->frames.size());
    std::vector<DicomSeries> parts;
    for (std::vector<DicomFrame>& frames : stationsOf(largest->frames)) {
        series.frames = std::move(frames);
        parts.push_back(series);
    }
    for (DicomSeries& part : parts) {
        part.part = static_cast<int>(&part - parts.data()) + 1;
        part.parts = static_cast<int>(parts.size());
    }
    return parts;
}

// Whole components of a UID, or what has a dot: a number alone is the end of many.
bool endsWith(const std::string& uid, const std::string& wanted)
{
    const bool dotted = wanted.find('.') != std::string::npos;
    const std::string end = dotted ? wanted : '.' + wanted;
    return uid.size() >= end.size() && uid.compare(uid.size() - end.size(), end.size(), end) == 0;
}

// Which of the series that are meant; none where several are.
std::optional<std::size_t> onlyOne(const std::vector<DicomSeries>& all,
                                   const std::vector<std::size_t>& matches)
{
    std::optional<std::size_t> one;
    for (const std::size_t i : matches) {
        if (one && all[*one].uid != all[i].uid) return std::nullopt;
        if (!one || all[i].voxels() > all[*one].voxels()) one = i;
    }
    return one;
}

// A file that lies in the folder twice, under two names.
bool isCopy(const DicomFile& a, const DicomFile& b)
{
    return a.instance == b.instance && !a.instance.empty() && a.series == b.series &&
           a.frames.size() == b.frames.size() &&
           a.frames.front().position == b.frames.front().position &&
           a.frames.front().order == b.frames.front().order;
}

Status noSuchSeries(const DicomStudy& study, const std::string& wanted, std::size_t matches)
{
    constexpr std::size_t MOST = 10;
    std::string text = "there " + std::string(matches ? "are several" : "is no") + " series \"" +
                       wanted + "\" among";
    for (std::size_t i = 0; i < std::min(study.series.size(), MOST); ++i) {
        const DicomSeries& s = study.series[i];
        text += (i ? ", " : " ") + std::to_string(i + 1) +
                (s.description.empty() ? "" : " \"" + s.description + '"') +
                (s.uid.empty() ? "" : " (" + s.uid + ")");
    }
    if (study.series.size() > MOST) text += ", ...";
    return {ErrorCode::VALUE_INVALID, text};
}

} // namespace

Result<DicomStudy> readDicomStudy(const std::vector<std::string>& paths)
{
    DicomStudy study;
    Status first;
    std::vector<std::string> uids;
    std::multimap<std::string, std::size_t> byInstance;
    for (const std::string& path : paths) {
        Result<DicomFile> file = readDicomHeader(path);
        if (!file.ok()) {
            if (study.unread++ == 0) first = file.status;
            continue;
        }
        const auto [same, end] = byInstance.equal_range(file->instance);
        if (std::any_of(same, end, [&](const auto& known) {
                return isCopy(study.files[known.second], *file);
            })) {
            ++study.copies;
            continue;
        }
        byInstance.emplace(file->instance, study.files.size());
        for (DicomFrame& frame : file->frames)
            frame.file = static_cast<int>(study.files.size());
        if (std::find(uids.begin(), uids.end(), file->series) == uids.end())
            uids.push_back(file->series);
        study.files.push_back(std::move(*file));
    }
    study.firstReason = first.text;
    if (study.files.empty()) return first;
    for (const std::string& uid : uids) {
        scalePet(study.files, uid);
        for (DicomSeries& series : seriesOf(study.files, uid))
            study.series.push_back(std::move(series));
    }
    std::stable_sort(
        study.series.begin(), study.series.end(),
        [](const DicomSeries& a, const DicomSeries& b) { return a.number < b.number; });
    return study;
}

Result<std::size_t> chooseSeries(const DicomStudy& study, const std::string& wanted)
{
    const std::vector<DicomSeries>& all = study.series;
    if (wanted.empty())
        return std::size_t(std::max_element(all.begin(), all.end(),
                                            [](const DicomSeries& a, const DicomSeries& b) {
                                                return a.voxels() < b.voxels();
                                            }) -
                           all.begin());
    std::int64_t number = 0;
    if (core::parseInteger(wanted, number) && number >= 1 &&
        number <= static_cast<std::int64_t>(all.size()))
        return static_cast<std::size_t>(number - 1);
    std::vector<std::size_t> matches;
    const auto match = [&](const auto& isMeant) {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (isMeant(all[i])) matches.push_back(i);
        return !matches.empty();
    };
    const bool found =
        (number >= 1 &&
         match([number](const DicomSeries& s) { return s.number == double(number); })) ||
        match([&](const DicomSeries& s) { return s.uid == wanted || s.description == wanted; });
    if (!found) match([&](const DicomSeries& s) { return endsWith(s.uid, wanted); });
    if (const std::optional<std::size_t> one = onlyOne(all, matches)) return *one;
    return noSuchSeries(study, wanted, matches.size());
}

} // namespace medical
} // namespace osgVolumizer
