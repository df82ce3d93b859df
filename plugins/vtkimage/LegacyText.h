#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace osgVolumizer {
namespace vtkimage {

/// A legacy file, as VTK's own reader goes through it: words, lines, numbers.
class LegacyText
{
public:
    explicit LegacyText(const std::string& path);

    std::int64_t bytes() const { return _bytes; }
    /// The next word between blanks, of 1024 bytes at most; empty at the end.
    std::string word();
    /// The same in lower case, as keywords are compared.
    std::string keyword();
    /// A whole number; false, and the word is gone, for anything else.
    bool number(std::int64_t& value);
    /// What is left of a line, of 1024 bytes at most; false at the end of the file.
    bool line(std::string& text);
    /// Passes over numbers, as text or (after the end of a line) in binary; false where the file
    /// ends before, or there is no number, as VTK reads them: "nan" and "inf" are none.
    bool skip(const std::string& type, std::int64_t count, bool binary);
    /// The word that was no number; empty where the file ended.
    const std::string& noNumber() const { return _noNumber; }
    /// Bits that a value of a type has; 0: not known, -1: text.
    static int bitsOf(const std::string& type);

private:
    bool skipWords(std::int64_t count);
    bool skipBytes(std::int64_t count);
    bool skipTexts(std::int64_t count, bool binary);
    std::int64_t left();

    std::filebuf _file;
    std::int64_t _bytes = 0;
    std::string _noNumber;
};

} // namespace vtkimage
} // namespace osgVolumizer
