#include "../vtk/ErrorKeeper.h"
#include "FileHead.h"

#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/Text.h>

#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace osgVolumizer {
namespace vtkimage {

namespace {

namespace fs = std::filesystem;

Status broken(const std::string& what)
{
    return {ErrorCode::FILE_UNREADABLE, what};
}

std::string attributeOf(vtkXMLDataElement& element, const char* name)
{
    const char* value = element.GetAttribute(name);
    return value ? value : "";
}

bool isNamed(vtkXMLDataElement& element, std::string_view name)
{
    return element.GetName() && element.GetName() == name;
}

// How much denser than raw a compressor packs at most, and a little more.
std::int64_t densityOf(const std::string& compressor)
{
    if (compressor.empty()) return 1;
    return compressor == "vtkLZMADataCompressor" ? 1 << 14 : 1 << 11;
}

struct XmlType
{
    const char* name;
    int bytes;
};
constexpr XmlType XML_TYPES[] = {{"Int8", 1},    {"UInt8", 1},   {"Int16", 2},  {"UInt16", 2},
                                 {"Int32", 4},   {"UInt32", 4},  {"Int64", 8},  {"UInt64", 8},
                                 {"Float32", 4}, {"Float64", 8}, {"String", 1}, {"Bit", 0}};

// Numbers of points and cells of an extent.
struct Counts
{
    std::int64_t points = 0, cells = 0, longest = 0;
};

/// A file as VTK's parser sees it, without its data.
class XmlFile
{
public:
    Result<FileHead> read(const std::string& path);
    /// Bytes that its arrays may have, unpacked.
    std::int64_t mostBytes() const { return _most; }

private:
    Result<Counts> countsOf(const std::string& extent) const;
    Status readPieces(vtkXMLDataElement& primary, const std::string& path);
    Status readArrays(vtkXMLDataElement& parent, const Counts& counts);
    Status readArray(vtkXMLDataElement& element, bool cells, std::int64_t tuples);

    FileHead _head;
    std::int64_t _bytes = 0, _most = 0;
};

Result<Counts> XmlFile::countsOf(const std::string& extent) const
{
    constexpr std::int64_t FURTHEST = std::int64_t(1) << 30;
    const auto words = core::splitBlanks(extent);
    Counts counts{1, 1, 0};
    std::int64_t ends[6];
    bool good = words.size() == 6;
    for (std::size_t i = 0; i < 6 && good; ++i)
        good = core::parseInteger(words[i], ends[i]) && std::abs(ends[i]) <= FURTHEST;
    for (std::size_t i = 0; i < 6 && good; i += 2)
        good = ends[i] <= ends[i + 1];
    if (!good) return Status(broken("its extent is \"" + extent + "\", no six numbers in order"));
    for (std::size_t i = 0; i < 6; i += 2) {
        const std::int64_t n = ends[i + 1] - ends[i] + 1;
        if (counts.points > std::max<std::int64_t>(8 * _most, 8) / n)
            return Status(broken("it has " + std::to_string(_bytes) +
                                 " bytes, fewer than its extent " + extent + " calls for"));
        counts.points *= n;
        counts.cells *= std::max<std::int64_t>(n - 1, 1);
        counts.longest = std::max(counts.longest, n);
    }
    return counts;
}

Status XmlFile::readArray(vtkXMLDataElement& element, bool cells, std::int64_t tuples)
{
    const std::string type = attributeOf(element, "type"), name = attributeOf(element, "Name");
    const auto known = std::find_if(std::begin(XML_TYPES), std::end(XML_TYPES),
                                    [&type](const XmlType& t) { return type == t.name; });
    if (known == std::end(XML_TYPES))
        return broken("numbers of type \"" + type + "\" are not known");
    std::int64_t components = 1;
    const std::string said = attributeOf(element, "NumberOfComponents");
    if (!said.empty() && (!core::parseInteger(said, components) || components < 1))
        return broken("array \"" + name + "\" has \"" + said + "\" components");
    const bool bits = known->bytes == 0, text = type == "String";
    // A number of text has a digit at least, and a blank.
    const bool ascii = attributeOf(element, "format") == "ascii";
    const std::int64_t perValue = ascii ? 1 : std::max(known->bytes, 1);
    const std::int64_t most = ascii ? _bytes : bits ? 8 * _most + 8 : _most;
    if (components > most || (tuples > 0 && components > most / tuples / perValue))
        return broken("it has " + std::to_string(_bytes) + " bytes, fewer than " +
                      std::to_string(tuples) + " times " + std::to_string(components) +
                      " values of array \"" + name + "\" call for");
    if (!text) _head.add({name, cells, static_cast<int>(components)});
    return {};
}

Status XmlFile::readArrays(vtkXMLDataElement& parent, const Counts& counts)
{
    for (int i = 0; i < parent.GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement& group = *parent.GetNestedElement(i);
        const bool points = isNamed(group, "PointData") || isNamed(group, "PPointData");
        const bool cells = isNamed(group, "CellData") || isNamed(group, "PCellData");
        const std::string active = attributeOf(group, "Scalars");
        if (points && _head.scalars.empty()) _head.scalars = active;
        if (cells && _head.cellScalars.empty()) _head.cellScalars = active;
        for (int k = 0; (points || cells) && k < group.GetNumberOfNestedElements(); ++k) {
            vtkXMLDataElement& array = *group.GetNestedElement(k);
            if (Status status = readArray(array, cells, points ? counts.points : counts.cells);
                !status.ok())
                return status;
        }
        if (points || cells || isNamed(group, "Piece")) continue;
        // Coordinates and data of no place: as many as they say themselves.
        for (int k = 0; k < group.GetNumberOfNestedElements(); ++k) {
            vtkXMLDataElement& array = *group.GetNestedElement(k);
            std::int64_t tuples = counts.longest;
            const std::string said = attributeOf(array, "NumberOfTuples");
            if (!said.empty() &&
                (!core::parseInteger(said, tuples) || tuples < 0 || tuples > _most))
                return broken("array \"" + attributeOf(array, "Name") + "\" has \"" + said +
                              "\" values, in a file of " + std::to_string(_bytes) + " bytes");
        }
    }
    return {};
}

// Each of a parallel file has to be whole.
Status XmlFile::readPieces(vtkXMLDataElement& primary, const std::string& path)
{
    for (int i = 0; i < primary.GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement& piece = *primary.GetNestedElement(i);
        const std::string source = attributeOf(piece, "Source");
        if (!isNamed(piece, "Piece")) continue;
        if (source.empty()) return broken("a piece of it has no source");
        const std::string file = (fs::path(path).parent_path() / source).string();
        if (Status status = core::requireRegularFile(file); !status.ok())
            return broken("a piece of it is missing: " + status.text);
        XmlFile own;
        const Result<FileHead> head = own.read(file);
        if (!head.ok())
            return broken("a piece of it is damaged: " + file + ": " + head.status.text);
        if (!head->pieces.empty() || head->rectilinear != _head.rectilinear)
            return broken("a piece of it is of another kind: " + file);
        _head.pieces.push_back(file);
        _most += own.mostBytes();
        _bytes += own._bytes;
    }
    return {};
}

Result<FileHead> XmlFile::read(const std::string& path)
{
    std::error_code failed;
    _bytes = static_cast<std::int64_t>(fs::file_size(path, failed));
    if (failed) return Status(broken(failed.message()));
    vtk::ErrorKeeper errors;
    vtkNew<vtkXMLDataParser> parser;
    errors.watch(*parser);
    parser->SetFileName(path.c_str());
    const bool parsed = parser->Parse() != 0;
    vtkXMLDataElement* root = parser->GetRootElement();
    if (!parsed || !root || !errors.error().empty())
        return Status(broken(errors.error().empty() ? "it is no whole XML" : errors.error()));
    std::string kind = attributeOf(*root, "type");
    vtkXMLDataElement* primary = root->FindNestedElementWithName(kind.c_str());
    if (!isNamed(*root, "VTKFile") || !primary)
        return Status(broken("it is XML, but has no data set of VTK"));
    const bool parallel = kind == "PImageData" || kind == "PRectilinearGrid";
    if (parallel) kind.erase(0, 1);
    if (kind != "ImageData" && kind != "RectilinearGrid") return notAVolume(kind);
    _head.xml = true;
    _head.rectilinear = kind == "RectilinearGrid";
    _most = _bytes * densityOf(attributeOf(*root, "compressor"));
    if (parallel)
        if (Status status = readPieces(*primary, path); !status.ok()) return status;
    const Result<Counts> whole = countsOf(attributeOf(*primary, "WholeExtent"));
    if (!whole.ok()) return whole.status;
    const auto times = core::splitBlanks(attributeOf(*primary, "TimeValues"));
    _head.steps = parallel ? 1 : std::max(static_cast<int>(times.size()), 1);
    Status status = readArrays(*primary, *whole);
    for (int i = 0; i < primary->GetNumberOfNestedElements() && status.ok() && !parallel; ++i) {
        vtkXMLDataElement& piece = *primary->GetNestedElement(i);
        if (!isNamed(piece, "Piece")) continue;
        const Result<Counts> part = countsOf(attributeOf(piece, "Extent"));
        status = part.ok() ? readArrays(piece, *whole) : part.status;
    }
    if (!status.ok()) return status;
    return _head;
}

} // namespace

Result<FileHead> readXmlHead(const std::string& path)
{
    return XmlFile().read(path);
}

} // namespace vtkimage
} // namespace osgVolumizer
