#pragma once

#include <osgVolumizer/core/Status.h>

#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace vtkimage {

/// A type of numbers as XML files name it.
struct XmlType
{
    const char* name;
    int bytes; ///< 0: bits
    int word;  ///< VTK's number of it

    bool isNumber() const { return word != 0; }
};
/// Nothing where it is not known.
std::optional<XmlType> xmlTypeOf(const std::string& name);

/// How many times fewer bytes than raw a compressor makes at most, and a little more; 1 for none,
/// 0 for one that is not known.
std::int64_t densityOf(const std::string& compressor);

/// The data in a file that was parsed. VTK's readers leave memory as it was where there are fewer
/// numbers than they expect, or letters that are none of base64, and make room for as many
/// compressed blocks as the file says.
class XmlData
{
public:
    /// `parser` has parsed `stream`, and outlives this.
    XmlData(vtkXMLDataParser& parser, std::ifstream& stream, std::int64_t fileBytes);

    /// Whether an array has `count` numbers at least; nothing is unpacked. FILE_UNREADABLE, in
    /// words that do not name the file.
    Status check(vtkXMLDataElement& array, const XmlType& type, std::int64_t count);

private:
    std::int64_t positionOf(vtkXMLDataElement& array);
    bool isEncoded(vtkXMLDataElement& array) const;
    /// The numbers in front of data.
    bool readWords(std::int64_t position, bool encoded, std::int64_t count,
                   std::vector<std::uint64_t>& words);
    bool isThere(std::int64_t position, bool encoded, std::int64_t bytes);
    bool arePackedBlocks(std::int64_t position, bool encoded, std::int64_t bytes);
    bool areBytes(std::int64_t position, bool encoded, std::int64_t bytes);

    vtkXMLDataParser& _parser;
    std::ifstream& _stream;
    std::int64_t _bytes;
    bool _packed = false, _wide = false, _bigEndian = false, _encoded = true;
};

} // namespace vtkimage
} // namespace osgVolumizer
