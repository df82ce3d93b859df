#include "Codec.h"
#include "Tokens.h"

namespace osgVolumizer {
namespace serializers {
namespace {

/// Tokens of the record under way. Knows how deep in brackets it is, so that its end can be found.
class Tokens
{
public:
    explicit Tokens(osgDB::InputStream& is) : _is(is) {}

    /// False where the stream has ended.
    bool next(std::string& token)
    {
        // An XML iterator gives nothing once between two elements.
        for (int attempt = 0; attempt < 3; ++attempt) {
            token.clear();
            _is >> token;
            if (_is.getException()) return false;
            if (!token.empty()) break;
        }
        if (_first) _brackets = token == "{";
        _first = false;
        if (token == "{") ++_depth;
        if (token == "}") --_depth;
        _ended = token.empty() || (_brackets ? _depth <= 0 : token == "End");
        return !token.empty();
    }
    bool inBrackets() const { return _brackets; }
    bool ended() const { return _ended; }
    /// Goes on to the end of the record.
    void skip()
    {
        std::string token;
        while (!_ended && next(token)) {
        }
    }

private:
    osgDB::InputStream& _is;
    bool _first = true, _brackets = false, _ended = false;
    int _depth = 0;
};

Status cutShort(const std::string& field)
{
    return Status(ErrorCode::FILE_UNREADABLE, "the file ends in field " + field);
}

Status tooMany(const std::string& field, std::uint64_t count)
{
    return Status(ErrorCode::SIZE_MISMATCH,
                  "field " + field + " has more than its " + std::to_string(count) + " values");
}

/// Values of one field.
class ValueReader
{
public:
    ValueReader(Tokens& tokens, std::string name, std::uint64_t count)
        : _tokens(tokens), _name(std::move(name)), _count(count)
    {
    }

    template <class T>
    Status operator()(std::vector<T>& values)
    {
        std::string token;
        while (values.size() < _count) {
            if (!next(token)) return cutShort(_name);
            T value{};
            if (!parseNumber(token, value)) return refuse(values.size(), token);
            values.push_back(value);
        }
        return close();
    }
    Status operator()(std::string& text)
    {
        std::string token;
        if (_count != 1 || !next(token)) return cutShort(_name);
        if (!unquote(token) || !unescape(token, text)) return refuse(0, token);
        return close();
    }
    Status operator()(Bytes& bytes)
    {
        std::string token;
        std::uint32_t size = 0;
        if (!_tokens.next(token)) return cutShort(_name);
        if (!parseNumber(token, size) || (size != 1 && size != 2 && size != 4 && size != 8))
            return Status(ErrorCode::VALUE_INVALID,
                          "field " + _name + " has samples of '" + token + "' bytes");
        bytes.elementSize = size;
        if (_count == 0 || _count > (std::uint64_t(1) << 60))
            return Status(ErrorCode::SIZE_MISMATCH,
                          "field " + _name + " cannot have " + std::to_string(_count) + " samples");
        while (bytes.data.size() / size < _count) {
            if (!next(token)) return cutShort(_name);
            if (!unquote(token) || !appendBase64(token, bytes.data))
                return refuse(bytes.data.size() / size, token);
        }
        if (bytes.data.size() != _count * size) return tooMany(_name, _count);
        bytes.swapUnlessLittleEndian();
        return close();
    }

private:
    /// The next value, past an opening bracket before the first one.
    bool next(std::string& token)
    {
        if (!_tokens.next(token)) return false;
        if (_begun || token != "{") {
            _begun = true;
            return true;
        }
        _begun = _bracket = true;
        return _tokens.next(token);
    }
    Status close()
    {
        std::string token;
        if (!_bracket) return Status();
        if (!_tokens.next(token)) return cutShort(_name);
        return token == "}" ? Status() : tooMany(_name, _count);
    }
    static bool unquote(std::string& token)
    {
        if (token.size() < 2 || token.front() != '"' || token.back() != '"') return false;
        token = token.substr(1, token.size() - 2);
        return true;
    }
    Status refuse(std::size_t index, const std::string& token) const
    {
        const auto i = static_cast<std::int64_t>(index);
        if (token == "}" || token == "{" || token == "End")
            return Status(ErrorCode::SIZE_MISMATCH,
                          "field " + _name + " has " + std::to_string(index) +
                              " values instead of " + std::to_string(_count),
                          i);
        return Status(ErrorCode::VALUE_INVALID,
                      "field " + _name + ", value " + std::to_string(index) + " of " +
                          std::to_string(_count) + ", is '" + token.substr(0, 40) + "'",
                      i);
    }

    Tokens& _tokens;
    std::string _name;
    std::uint64_t _count;
    bool _begun = false, _bracket = false;
};

// `count` is what the field says of itself.
Status readField(Tokens& tokens, const std::string& name, Record& record, std::uint64_t& count)
{
    std::string kind, number;
    if (!tokens.next(kind) || !tokens.next(number)) return cutShort(name);
    std::int64_t n = 0;
    if (!parseNumber(number, n) || n < 0)
        return Status(ErrorCode::VALUE_INVALID,
                      "field " + name + " has '" + number.substr(0, 40) + "' values");
    count = std::uint64_t(n);
    static const Field::Value values[kindCount] = {Field::Integers(), Field::Doubles(),
                                                   Field::Indices(), std::string(), Bytes()};
    for (std::size_t k = 0; k < kindCount; ++k) {
        if (kind != kindName(k)) continue;
        Field::Value value = values[k];
        Status status = std::visit(ValueReader(tokens, name, count), value);
        if (status.ok()) record.add(name, std::move(value));
        return status;
    }
    return Status(ErrorCode::VALUE_INVALID,
                  "field " + name + " is of unknown kind '" + kind.substr(0, 40) + "'");
}

bool isName(const std::string& token)
{
    return (token[0] >= 'A' && token[0] <= 'Z') || (token[0] >= 'a' && token[0] <= 'z');
}

Status readFields(Tokens& tokens, Record& record)
{
    std::string token, previous = "Version";
    std::uint64_t count = 0;
    if (!tokens.next(token)) return cutShort(previous);
    if (tokens.inBrackets() && !tokens.next(token)) return cutShort(previous);
    while (token != "End") {
        if (tokens.ended())
            return Status(ErrorCode::FILE_UNREADABLE, "there is no End after field " + previous);
        if (!isName(token)) return tooMany(previous, count);
        Status status = readField(tokens, token, record, count);
        if (!status.ok()) return status;
        previous = token;
        if (!tokens.next(token)) return cutShort(previous);
    }
    if (tokens.inBrackets()) tokens.next(token);
    return Status();
}

} // namespace

Status readText(osgDB::InputStream& is, Record& record)
{
    Tokens tokens(is);
    Status status = readFields(tokens, record);
    tokens.skip();
    return status;
}

} // namespace serializers
} // namespace osgVolumizer
