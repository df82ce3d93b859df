#pragma once

#include <gdcmDataSet.h>

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace medical {

/// The elements of a DICOM data set, as text and numbers. What is missing, empty or of another form
/// is an empty text, no number, or none.
class Elements
{
public:
    explicit Elements(const gdcm::DataSet& set) : _set(set) {}

    bool has(const gdcm::Tag& tag) const;
    /// The bytes of its value.
    std::string raw(const gdcm::Tag& tag) const;
    /// Without blanks at its ends.
    std::string text(const gdcm::Tag& tag) const;
    /// Of decimal text (DS, IS), between backslashes; empty unless all are finite numbers.
    std::vector<double> decimals(const gdcm::Tag& tag) const;
    std::optional<double> decimal(const gdcm::Tag& tag) const;
    /// Of binary words of 16 or 32 bits (US, UL), or FD.
    std::optional<int> word(const gdcm::Tag& tag) const;
    std::optional<unsigned> longWord(const gdcm::Tag& tag) const;
    std::vector<unsigned> words(const gdcm::Tag& tag) const;
    /// The items of a sequence.
    std::vector<gdcm::DataSet> items(const gdcm::Tag& tag) const;
    /// The first one.
    std::optional<gdcm::DataSet> item(const gdcm::Tag& tag) const;

private:
    const gdcm::ByteValue* bytes(const gdcm::Tag& tag) const;

    const gdcm::DataSet& _set;
};

} // namespace medical
} // namespace osgVolumizer
