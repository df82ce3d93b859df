#include "LookupTable.h"

#include "core/RegularFile.h"
#include "core/Text.h"
#include "io/ForeignTable.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace osgVolumizer {

namespace {

using Point = core::TransferFunction::Point;

/// The lines of a text, without comments and byte order mark.
class Lines
{
public:
    Lines(std::string_view text, const std::string& name) : _rest(text), _name(name)
    {
        if (_rest.substr(0, 3) == "\xEF\xBB\xBF") _rest.remove_prefix(3);
    }
    /// False at the end of the text.
    bool next(std::vector<std::string_view>& words)
    {
        if (_rest.empty()) return false;
        ++_number;
        const std::size_t end = _rest.find('\n');
        std::string_view line = _rest.substr(0, end);
        _rest.remove_prefix(end == std::string_view::npos ? _rest.size() : end + 1);
        words = core::splitBlanks(line.substr(0, line.find('#')));
        return true;
    }
    Status error(const std::string& what) const
    {
        return {ErrorCode::VALUE_INVALID, _name + ", line " + std::to_string(_number) + ": " + what,
                _number};
    }

private:
    std::string_view _rest;
    const std::string& _name;
    std::int64_t _number = 0;
};

/// A word in a message: quoted, and no longer than a line.
std::string quoted(std::string_view word)
{
    return "\"" + std::string(word.substr(0, 60)) + (word.size() > 60 ? "..." : "") + "\"";
}

const char* const fieldNames[] = {"value", "red", "green", "blue", "opacity"};

/// Parses "value r g b a"; the message says what is wrong, empty when nothing is.
std::string parsePoint(const std::vector<std::string_view>& words, double fullScale, Point& point)
{
    for (std::size_t i = 0; i < 5; ++i) {
        double number = 0.0;
        if (!core::parseNumber(words[i], number) || !std::isfinite(number))
            return std::string(fieldNames[i]) + " " + quoted(words[i]) + " is not a finite number";
        if (i == 0) {
            point.value = number;
            continue;
        }
        number /= fullScale;
        if (!(number >= 0.0 && number <= 1.0))
            return std::string(fieldNames[i]) + " " + quoted(words[i]) + " is outside [0, " +
                   core::formatNumber(fullScale) + "]";
        point.color[static_cast<int>(i) - 1] = number;
    }
    return {};
}

Result<std::string> readText(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    constexpr std::uintmax_t maximum = 64u << 20;
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (!failed && size > maximum)
        return Status(ErrorCode::TOO_LARGE, path + " has " + std::to_string(size) +
                                                " bytes, more than 64 MiB, as no lookup table has");
    std::ifstream file(path, std::ios::binary);
    if (failed || !file) return Status(ErrorCode::FILE_UNREADABLE, path + " cannot be read");
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    return text;
}

} // namespace

Result<LookupPoints> parseLookupTable(const std::string& text, const std::string& name)
{
    LookupPoints points;
    Lines lines(text, name);
    std::vector<std::string_view> words;
    while (lines.next(words)) {
        if (words.empty()) continue;
        if (words.size() != 5)
            return lines.error(
                "has " + std::to_string(words.size()) +
                " words where five numbers belong: value, red, green, blue, opacity");
        Point point;
        const std::string wrong = parsePoint(words, 1.0, point);
        if (!wrong.empty()) return lines.error(wrong);
        if (!points.empty() && point.value < points.back().value)
            return lines.error("value " + quoted(words[0]) + " is below that of the line before, " +
                               core::formatNumber(points.back().value));
        points.push_back(point);
    }
    if (points.empty())
        return Status(ErrorCode::VALUE_INVALID, name + " has no line \"value r g b a\"");
    return points;
}

Result<LookupPoints> parseTransferFunctionFile(const std::string& text, const std::string& name)
{
    LookupPoints points;
    double fullScale = 255.0;
    Lines lines(text, name);
    std::vector<std::string_view> words;
    while (lines.next(words)) {
        if (words.empty()) continue;
        if (words[0] == "colour-scale" || words[0] == "color-scale") {
            double full = 0.0;
            if (words.size() < 2 || !core::parseNumber(words[1], full) || !(full > 0.0) ||
                !std::isfinite(full))
                return lines.error("colour scale " + quoted(words.size() < 2 ? "" : words[1]) +
                                   " is not a positive number");
            fullScale = full;
            continue;
        }
        // Whatever follows the fifth word is a comment in this format.
        if (words.size() < 5)
            return lines.error(
                "has " + std::to_string(words.size()) +
                " words where five numbers belong: value, red, green, blue, opacity");
        Point point;
        const std::string wrong = parsePoint(words, fullScale, point);
        if (!wrong.empty()) return lines.error(wrong);
        points.push_back(point);
    }
    if (points.empty())
        return Status(ErrorCode::VALUE_INVALID, name + " has no line \"value r g b a\"");
    std::stable_sort(points.begin(), points.end(),
                     [](const Point& a, const Point& b) { return a.value < b.value; });
    return points;
}

Result<osg::ref_ptr<LookupTable>> readLookupTable(const std::string& fileName,
                                                  const osgDB::Options* options)
{
    const std::string path = osgDB::findDataFile(fileName, options);
    if (path.empty())
        return Status(ErrorCode::FILE_NOT_FOUND, "lookup table " + fileName + " was not found");
    Result<std::string> text = readText(path);
    if (!text.ok()) return text.status;
    const bool tf = osgDB::getLowerCaseFileExtension(fileName) == "tf";
    Result<LookupPoints> points =
        tf ? parseTransferFunctionFile(*text, fileName) : parseLookupTable(*text, fileName);
    if (!points.ok()) {
        const std::string foreign = io::foreignTableFormat(*text, fileName);
        if (foreign.empty()) return points.status;
        return Status(ErrorCode::NOT_SUPPORTED,
                      "lookup table " + fileName + " is " + foreign +
                          "; what can be read is a .lut, lines of value, red, green, blue and "
                          "opacity, and a .tf");
    }
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const CallerReports quiet;
    const Status status = table->setPoints(std::move(*points), LookupTable::DATA_VALUES);
    if (!status.ok()) return status;
    table->setFileName(fileName);
    table->setFilePath(std::filesystem::absolute(path).string());
    return table;
}

Status writeLookupTable(const LookupTable& table, const std::string& fileName,
                        const osg::Vec2d& range)
{
    core::TransferFunction function = *table.getFunction();
    if (table.getDomain() == LookupTable::RANGE_FRACTION)
        function = function.mapped(range.y() - range.x(), range.x());
    if (Status status = core::requireRegularTarget(fileName); !status.ok()) return status;
    std::ofstream file(fileName, std::ios::binary);
    file << "# value red green blue opacity\n";
    for (const Point& p : function.points()) {
        file << core::formatNumber(p.value);
        for (int c = 0; c < 4; ++c)
            file << ' ' << core::formatNumber(p.color[c]);
        file << '\n';
    }
    file.close();
    if (!file) return {ErrorCode::FILE_UNREADABLE, fileName + " cannot be written"};
    return {};
}

} // namespace osgVolumizer
