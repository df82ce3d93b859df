#include "PluginFile.h"
#include "VoxelFiles.h"

#include "../core/Text.h"

#include <OpenImageIO/imageio.h>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>

namespace osgVolumizer {
namespace io {

namespace {

namespace fs = std::filesystem;

bool isDigit(char c)
{
    return c >= '0' && c <= '9';
}

/// Lower-case extensions of all formats: "format:ext,ext;format:ext".
bool isImageExtension(std::string extension)
{
    static const std::string list = [] {
        std::string all = OIIO::get_string_attribute("extension_list");
        std::replace_if(
            all.begin(), all.end(), [](char c) { return c == ':' || c == ';'; }, ',');
        return "," + all + ",";
    }();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return list.find("," + extension + ",") != std::string::npos;
}

/// The regular files of a folder, by name, or of all folders in it; FILE_UNREADABLE where it cannot
/// be listed.
Result<std::vector<std::string>> filesOf(const std::string& folder, bool deep)
{
    constexpr std::size_t MOST = 1 << 20;
    std::vector<std::string> names;
    std::error_code failed;
    fs::recursive_directory_iterator entry(folder.empty() ? "." : folder,
                                           fs::directory_options::skip_permission_denied, failed),
        end;
    while (!failed && entry != end && names.size() < MOST) {
        std::error_code unknown;
        const bool hidden = entry->path().filename().string()[0] == '.';
        if (!hidden && entry->is_regular_file(unknown))
            names.push_back(
                entry->path().lexically_relative(folder.empty() ? "." : folder).string());
        if (!deep || hidden) entry.disable_recursion_pending();
        entry.increment(failed);
    }
    if (failed)
        return Status(ErrorCode::FILE_UNREADABLE,
                      folder + " cannot be listed: " + failed.message());
    return names;
}

/// The file beside folders of DICOM that names what is in them.
bool isDirectoryFile(const std::string& name)
{
    return osgDB::convertToLowerCase(name).compare(0, 8, "dicomdir") == 0;
}

/// Without the numbers beside headers: a.img beside a.hdr.
std::vector<std::string> withoutPairs(std::vector<std::string> paths)
{
    const auto isHalf = [&paths](const std::string& path) {
        const std::size_t img = path.rfind(".img");
        return img != std::string::npos &&
               std::find(paths.begin(), paths.end(), path.substr(0, img) + ".hdr") != paths.end();
    };
    std::vector<std::string> whole;
    std::remove_copy_if(paths.begin(), paths.end(), std::back_inserter(whole), isHalf);
    return whole;
}

/// A numbered pattern: prefix, digits, suffix.
struct Pattern
{
    std::string folder, prefix, suffix;
    std::size_t width = 0; ///< digits are padded with zeros to this

    /// The number in a file name; false where it does not match.
    bool match(const std::string& name, std::int64_t& number) const
    {
        const std::size_t ends = prefix.size() + suffix.size();
        if (name.size() <= ends || name.compare(0, prefix.size(), prefix) != 0 ||
            name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0)
            return false;
        const std::string digits = name.substr(prefix.size(), name.size() - ends);
        if (!std::all_of(digits.begin(), digits.end(), isDigit) || digits.size() < width)
            return false;
        const bool padded = digits.size() > std::max<std::size_t>(width, 1) && digits[0] == '0';
        return !padded && core::parseInteger(digits, number);
    }
};

/// Where "%d", "%0nd" or a run of '#' is in a file name: [begin, end); end == 0 where there is
/// none.
struct Field
{
    std::size_t begin = 0, end = 0, width = 0;
};

Field findField(const std::string& name)
{
    Field field;
    const std::size_t hash = name.rfind('#');
    if (hash != std::string::npos) {
        field.end = hash + 1;
        field.begin = hash;
        while (field.begin > 0 && name[field.begin - 1] == '#')
            --field.begin;
        field.width = field.end - field.begin;
        return field;
    }
    const std::size_t percent = name.rfind('%');
    if (percent == std::string::npos) return field;
    std::size_t d = percent + 1;
    while (d < name.size() && isDigit(name[d]))
        ++d;
    if (d == name.size() || name[d] != 'd' || d - percent > 3) return field;
    field.begin = percent;
    field.end = d + 1;
    // Only a zero pads: "%03d". A width without it would pad with blanks, as no file is named.
    std::int64_t width = 0;
    if (name[percent + 1] == '0' &&
        core::parseInteger(name.substr(percent + 1, d - percent - 1), width))
        field.width = static_cast<std::size_t>(width);
    return field;
}

Pattern parsePattern(const std::string& text)
{
    Pattern pattern;
    const std::size_t slash = text.find_last_of('/');
    const std::string name = slash == std::string::npos ? text : text.substr(slash + 1);
    if (slash != std::string::npos) pattern.folder = text.substr(0, slash + 1);
    const Field field = findField(name);
    pattern.prefix = name.substr(0, field.begin);
    pattern.suffix = name.substr(field.end);
    pattern.width = field.width;
    return pattern;
}

std::map<std::int64_t, std::string> numbered(const Pattern& pattern, const std::string& folder)
{
    std::map<std::int64_t, std::string> files;
    const Result<std::vector<std::string>> names = filesOf(folder, false);
    std::int64_t number = 0;
    for (const std::string& name : *names)
        if (pattern.match(name, number)) files[number] = (fs::path(folder) / name).string();
    return files;
}

} // namespace

bool naturalLess(const std::string& a, const std::string& b)
{
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (!isDigit(a[i]) || !isDigit(b[j])) {
            if (a[i] != b[j])
                return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
            ++i, ++j;
            continue;
        }
        const auto skipZeros = [](const std::string& s, std::size_t& k) {
            while (k + 1 < s.size() && s[k] == '0' && isDigit(s[k + 1]))
                ++k;
        };
        const auto digits = [](const std::string& s, std::size_t k) {
            std::size_t end = k;
            while (end < s.size() && isDigit(s[end]))
                ++end;
            return end - k;
        };
        skipZeros(a, i);
        skipZeros(b, j);
        const std::size_t m = digits(a, i), n = digits(b, j);
        if (m != n) return m < n;
        const int order = a.compare(i, m, b, j, n);
        if (order != 0) return order < 0;
        i += m, j += n;
    }
    if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
    return a < b; // equal but for zeros in front
}

Result<std::vector<std::string>> listFolder(const std::string& folder, bool volumes)
{
    Result<std::vector<std::string>> names = filesOf(folder, false);
    if (!names.ok()) return names;
    const bool wrapped = std::all_of(names->begin(), names->end(), isDirectoryFile);
    if (wrapped) names = filesOf(folder, true);
    if (!names.ok()) return names;
    std::vector<std::string> images, bare, dicom, others;
    for (const std::string& name : *names) {
        if (isDirectoryFile(fs::path(name).filename().string())) continue;
        const std::string path = (fs::path(folder) / name).string();
        const std::string extension = fs::path(name).extension().string();
        const FileKind kind = fileKindOf(path);
        if (kind == FileKind::DICOM)
            dicom.push_back(path);
        else if (kind != FileKind::IMAGE)
            others.push_back(path);
        else if (extension.empty())
            bare.push_back(path);
        else if (extension.size() > 1 && isImageExtension(extension.substr(1)))
            images.push_back(path);
    }
    if (!dicom.empty())
        images = dicom;
    else if (wrapped)
        images.clear(); // of other folders
    if (volumes && !others.empty() && dicom.empty()) images = withoutPairs(std::move(others));
    if (images.empty() && !wrapped) images = std::move(bare);
    if (images.empty())
        return Status(ErrorCode::FILE_NOT_FOUND,
                      "folder " + folder + " has no images" +
                          (others.empty() ? ""
                                          : ", but " + std::to_string(others.size()) +
                                                " volumes: name one of them, or say series=on "
                                                "where they are time steps"));
    std::sort(images.begin(), images.end(), naturalLess);
    return images;
}

bool looksLikePattern(const std::string& name)
{
    const std::size_t slash = name.find_last_of('/');
    return findField(slash == std::string::npos ? name : name.substr(slash + 1)).end > 0;
}

Result<std::vector<std::string>> listPattern(const std::string& text,
                                             const std::vector<std::string>& folders)
{
    const Pattern pattern = parsePattern(text);
    std::map<std::int64_t, std::string> files = numbered(pattern, pattern.folder);
    for (auto f = folders.begin(); files.empty() && f != folders.end(); ++f)
        files = numbered(pattern, (fs::path(*f) / pattern.folder).string());
    if (files.empty())
        return Status(ErrorCode::FILE_NOT_FOUND, "no file matches the pattern " + text);
    std::vector<std::string> paths;
    std::int64_t expected = files.begin()->first;
    for (const auto& [number, path] : files) {
        if (number != expected++)
            return Status(ErrorCode::FILE_NOT_FOUND,
                          "the pattern " + text + " has no file number " +
                              std::to_string(expected - 1) + ", but one of number " +
                              std::to_string(number));
        paths.push_back(path);
    }
    return paths;
}

} // namespace io
} // namespace osgVolumizer
