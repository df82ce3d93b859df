#include "Codec.h"
#include "Tokens.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

// A record as text, the same tokens in .osgt and .osgx:
//     { Version Integers 1 1  Layout Text 1 "V3F"  Vertices Doubles 12 { 0 0 0 ... }  End }
// Each field is name, kind, number of values (and for Bytes their size), values. In .osgx there are
// no brackets among the tokens, so "End" marks the end: no value reads like it.

namespace osgVolumizer {
namespace serializers {
namespace {

constexpr std::size_t valuesWithoutBrackets = 8; // more go on lines of their own
constexpr std::size_t bytesPerLine = 72;

thread_local std::streamsize callersDigits;

std::ios_base& saveDigits(std::ios_base& stream)
{
    callersDigits = stream.precision();
    return stream;
}

std::ios_base& restoreDigits(std::ios_base& stream)
{
    stream.precision(callersDigits);
    return stream;
}

template <int Digits>
std::ios_base& digits(std::ios_base& stream)
{
    stream.precision(Digits);
    return stream;
}

bool readsBack(double value, int digits)
{
    char text[40];
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    return std::strtod(text, nullptr) == value;
}

// With as few of 15 to 17 digits as give the same number back.
void writeValue(osgDB::OutputStream& os, double value)
{
    os << saveDigits;
    if (readsBack(value, 15))
        os << digits<15>;
    else if (readsBack(value, 16))
        os << digits<16>;
    else
        os << digits<17>;
    os << value << restoreDigits;
}

void writeValue(osgDB::OutputStream& os, std::int64_t value)
{
    os << static_cast<long>(value);
}

void writeValue(osgDB::OutputStream& os, std::uint32_t value)
{
    os << value;
}

struct WriteValue
{
    osgDB::OutputStream& os;
    std::size_t valuesPerLine;

    template <class T>
    void operator()(const std::vector<T>& values) const
    {
        os << static_cast<unsigned long>(values.size());
        const bool lines = values.size() > valuesWithoutBrackets;
        if (lines) os << os.BEGIN_BRACKET << std::endl;
        for (std::size_t i = 0; i < values.size(); ++i) {
            writeValue(os, values[i]);
            if (lines && (i % valuesPerLine == valuesPerLine - 1 || i + 1 == values.size()))
                os << std::endl;
        }
        if (lines) os << os.END_BRACKET;
        os << std::endl;
    }
    void operator()(const std::string& text) const
    {
        os << 1ul;
        os.writeWrappedString(escaped(text));
        os << std::endl;
    }
    void operator()(Bytes bytes) const
    {
        bytes.swapUnlessLittleEndian();
        os << static_cast<unsigned long>(bytes.data.size() / bytes.elementSize) << bytes.elementSize
           << os.BEGIN_BRACKET << std::endl;
        for (std::size_t i = 0; i < bytes.data.size(); i += bytesPerLine) {
            const std::size_t n = std::min(bytesPerLine, bytes.data.size() - i);
            os.writeWrappedString(base64(bytes.data.data() + i, n));
            os << std::endl;
        }
        os << os.END_BRACKET << std::endl;
    }
};

} // namespace

void writeText(osgDB::OutputStream& os, const Record& record)
{
    os << os.BEGIN_BRACKET << std::endl;
    for (const Field& field : record.fields()) {
        os << os.PROPERTY(field.name.c_str()) << std::string(kindName(field.value.index()));
        std::visit(WriteValue{os, field.valuesPerLine}, field.value);
    }
    os << os.PROPERTY("End") << std::endl;
    os << os.END_BRACKET << std::endl;
}

} // namespace serializers
} // namespace osgVolumizer
