#include "../vtk/ErrorKeeper.h"
#include "Extent.h"
#include "FileHead.h"
#include "XmlData.h"

#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/Text.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
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

// As many numbers as there are; left alone where there are fewer, as VTK does.
template <std::size_t COUNT>
void readNumbers(vtkXMLDataElement& element, const char* name, std::array<double, COUNT>& numbers)
{
    std::array<double, COUNT> found;
    if (element.GetVectorAttribute(name, int(COUNT), found.data()) == int(COUNT)) numbers = found;
}

bool isNamed(vtkXMLDataElement& element, std::string_view name)
{
    return element.GetName() && element.GetName() == name;
}

Status tooLarge(std::int64_t bytes, const std::string& what)
{
    return broken("it has " + std::to_string(bytes) + " bytes, fewer than " + what + " calls for");
}

/// A file as VTK's parser sees it.
class XmlFile
{
public:
    /// \param isPiece of a parallel file, and so no parallel one
    explicit XmlFile(bool isPiece) : _isPiece(isPiece) {}
    Result<FileHead> read(const std::string& path);

private:
    Status readDataSet(vtkXMLDataElement& primary, const std::string& path);
    Status readPieces(vtkXMLDataElement& primary, const std::string& path);
    Status readPieceFile(const std::string& file, const Extent& extent);
    Status readExtent(vtkXMLDataElement& element, const char* name, Extent& extent) const;
    Status readArrays(vtkXMLDataElement& parent, const Extent& extent);
    Status readArray(vtkXMLDataElement& element, bool cells, std::int64_t tuples);
    Status checkArray(vtkXMLDataElement& element, std::int64_t tuples, std::int64_t& components);
    Status checkOthers(vtkXMLDataElement& group, const Extent& extent);

    const bool _isPiece;
    FileHead _head;
    Extent _whole;
    std::int64_t _bytes = 0, _most = 0; ///< of the file, and of its arrays when unpacked
    std::optional<XmlData> _data;       ///< of a file that has its own
};

// What VTK makes room for, before it sees what is there.
Status XmlFile::readExtent(vtkXMLDataElement& element, const char* name, Extent& extent) const
{
    const std::string text = attributeOf(element, name);
    if (!extent.parse(text))
        return broken("its extent is \"" + text + "\", no six numbers in order");
    return extent.points() > std::max<std::int64_t>(8 * _most, 8)
               ? tooLarge(_bytes, "its extent " + text)
               : Status();
}

Status XmlFile::checkArray(vtkXMLDataElement& element, std::int64_t tuples,
                           std::int64_t& components)
{
    const std::string type = attributeOf(element, "type"), name = attributeOf(element, "Name");
    const std::optional<XmlType> known = xmlTypeOf(type);
    if (!known) return broken("numbers of type \"" + type + "\" are not known");
    components = 1;
    const std::string said = attributeOf(element, "NumberOfComponents");
    if (!said.empty() && (!core::parseInteger(said, components) || components < 1))
        return broken("array \"" + name + "\" has \"" + said + "\" components");
    // A number of text has a digit at least. What a parallel file says of an array has no format:
    // its pieces, which were looked at, may be text.
    const bool ascii = attributeOf(element, "format") == "ascii";
    const std::int64_t perValue = ascii || !_data ? 1 : std::max(known->bytes, 1);
    const std::int64_t most = ascii ? _bytes : known->bytes == 0 ? 8 * _most + 8 : _most;
    if (components > most || (tuples > 0 && components > most / tuples / perValue))
        return tooLarge(_bytes, std::to_string(tuples) + " times " + std::to_string(components) +
                                    " numbers of array \"" + name + "\"");
    return _data ? _data->check(element, *known, tuples * components) : Status();
}

Status XmlFile::readArray(vtkXMLDataElement& element, bool cells, std::int64_t tuples)
{
    std::int64_t components = 1;
    if (Status status = checkArray(element, tuples, components); !status.ok()) return status;
    if (attributeOf(element, "type") != "String")
        _head.add({attributeOf(element, "Name"), cells, static_cast<int>(components)});
    return {};
}

// Of a piece, or of no place.
Status XmlFile::readArrays(vtkXMLDataElement& parent, const Extent& extent)
{
    for (int i = 0; i < parent.GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement& group = *parent.GetNestedElement(i);
        const bool points = isNamed(group, "PointData") || isNamed(group, "PPointData");
        const bool cells = isNamed(group, "CellData") || isNamed(group, "PCellData");
        if (isNamed(group, "Piece")) continue;
        if (!points && !cells) {
            if (Status status = checkOthers(group, extent); !status.ok()) return status;
            continue;
        }
        std::string& active = points ? _head.scalars : _head.cellScalars;
        if (active.empty()) active = attributeOf(group, "Scalars");
        const std::int64_t tuples = points ? extent.points() : extent.cells();
        for (int k = 0; k < group.GetNumberOfNestedElements(); ++k)
            if (Status status = readArray(*group.GetNestedElement(k), cells, tuples); !status.ok())
                return status;
    }
    return {};
}

// Coordinates; and data of no place, as many as they say themselves.
Status XmlFile::checkOthers(vtkXMLDataElement& group, const Extent& extent)
{
    const bool coordinates = isNamed(group, "Coordinates");
    if (coordinates && group.GetNumberOfNestedElements() != 3)
        return broken("it has coordinates of " + std::to_string(group.GetNumberOfNestedElements()) +
                      " axes");
    for (int i = 0; i < group.GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement& array = *group.GetNestedElement(i);
        std::int64_t tuples = coordinates ? extent.points(i) : 0, components = 1;
        const std::string said = attributeOf(array, "NumberOfTuples");
        if (!coordinates && !said.empty() && (!core::parseInteger(said, tuples) || tuples < 0))
            return broken("array \"" + attributeOf(array, "Name") + "\" has \"" + said +
                          "\" numbers");
        if (Status status = checkArray(array, tuples, components); !status.ok()) return status;
    }
    return {};
}

// Between the pieces, VTK leaves memory as it was.
Status XmlFile::readPieces(vtkXMLDataElement& primary, const std::string& path)
{
    std::int64_t cells = 0;
    for (int i = 0; i < primary.GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement& piece = *primary.GetNestedElement(i);
        if (!isNamed(piece, "Piece")) continue;
        Extent extent;
        const std::string source = attributeOf(piece, "Source");
        if (!extent.parse(attributeOf(piece, "Extent")))
            return broken("the extent of a piece is \"" + attributeOf(piece, "Extent") + "\"");
        Status status =
            _data ? readExtent(piece, "Extent", extent)
                  : readPieceFile((fs::path(path).parent_path() / source).string(), extent);
        if (status.ok()) status = readArrays(piece, extent);
        if (!status.ok()) return status;
        cells += std::min(extent.cells(_whole), _whole.cells());
    }
    if (cells < _whole.cells())
        return broken("its pieces have " + std::to_string(cells) + " of " +
                      std::to_string(_whole.cells()) + " cells");
    return {};
}

Status XmlFile::readPieceFile(const std::string& file, const Extent& extent)
{
    if (Status status = core::requireRegularFile(file); !status.ok())
        return broken("a piece of it is missing: " + status.text);
    XmlFile piece(true);
    const Result<FileHead> head = piece.read(file);
    if (!head.ok()) return broken("a piece of it is damaged: " + file + ": " + head.status.text);
    if (head->rectilinear != _head.rectilinear)
        return broken("a piece of it is of another kind: " + file);
    for (int axis = 0; axis < 3; ++axis)
        if (piece._whole.low[axis] > extent.low[axis] ||
            piece._whole.high[axis] < extent.high[axis])
            return broken("a piece of it is smaller than it says: " + file);
    _head.pieces.push_back(file);
    _most += piece._most;
    _bytes += piece._bytes;
    return {};
}

Status XmlFile::readDataSet(vtkXMLDataElement& primary, const std::string& path)
{
    if (!_whole.parse(attributeOf(primary, "WholeExtent")))
        return broken("its extent is \"" + attributeOf(primary, "WholeExtent") +
                      "\", no six numbers in order");
    readNumbers(primary, "Spacing", _head.spacing);
    readNumbers(primary, "Origin", _head.origin);
    readNumbers(primary, "Direction", _head.direction);
    if (Status status = readPieces(primary, path); !status.ok()) return status;
    if (Status status = readExtent(primary, "WholeExtent", _whole); !status.ok()) return status;
    if (Status status = readArrays(primary, _whole); !status.ok()) return status;
    // As large as the whole, where pieces are small.
    for (const ArrayInfo& array : _head.arrays)
        if ((array.cells ? _whole.cells() : _whole.points()) > 8 * _most / array.components)
            return tooLarge(_bytes, "array \"" + array.name + "\"");
    const auto times = core::splitBlanks(attributeOf(primary, "TimeValues"));
    if (_data) _head.steps = std::max(static_cast<int>(times.size()), 1);
    return {};
}

Result<FileHead> XmlFile::read(const std::string& path)
{
    std::error_code failed;
    _bytes = static_cast<std::int64_t>(fs::file_size(path, failed));
    if (failed) return Status(broken(failed.message()));
    std::ifstream stream(path, std::ios::binary);
    vtk::ErrorKeeper errors;
    vtkNew<vtkXMLDataParser> parser;
    errors.watch(*parser);
    parser->SetStream(&stream);
    const bool parsed = parser->Parse() != 0;
    vtkXMLDataElement* root = parser->GetRootElement();
    if (!parsed || !root || !errors.error().empty())
        return Status(broken(errors.error().empty() ? "it is no whole XML" : errors.error()));
    std::string kind = attributeOf(*root, "type");
    vtkXMLDataElement* primary = root->FindNestedElementWithName(kind.c_str());
    if (!isNamed(*root, "VTKFile") || !primary)
        return Status(broken("it is XML, but has no data set of VTK"));
    const bool parallel = kind == "PImageData" || kind == "PRectilinearGrid";
    if (parallel && _isPiece) return Status(broken("it has pieces itself"));
    if (parallel) kind.erase(0, 1);
    if (kind != "ImageData" && kind != "RectilinearGrid") return notAVolume(kind);
    _head.xml = true;
    _head.rectilinear = kind == "RectilinearGrid";
    const std::string compressor = attributeOf(*root, "compressor");
    if (densityOf(compressor) == 0)
        return Status(broken("it is compressed by \"" + compressor + "\", which is not known"));
    _most = _bytes * densityOf(compressor);
    if (!parallel) _data.emplace(*parser, stream, _bytes);
    if (Status status = readDataSet(*primary, path); !status.ok()) return status;
    if (!errors.error().empty()) return Status(broken(errors.error()));
    return _head;
}

} // namespace

Result<FileHead> readXmlHead(const std::string& path)
{
    return XmlFile(false).read(path);
}

} // namespace vtkimage
} // namespace osgVolumizer
