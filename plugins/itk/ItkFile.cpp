#include "ItkFile.h"

#include "NumberFile.h"

#include <osgVolumizer/core/RegularFile.h>
#include <osgVolumizer/core/Text.h>

#include <itkBioRadImageIO.h>
#include <itkGiplImageIO.h>
#include <itkMINCImageIO.h>
#include <itkMRCImageIO.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <osgDB/FileNameUtils>

#include <glm/geometric.hpp>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <mutex>

namespace osgVolumizer {
namespace medical {

namespace {

namespace fs = std::filesystem;
using IO = itk::ImageIOBase;
using Component = itk::CommonEnums::IOComponent;
using Pixel = itk::CommonEnums::IOPixel;

/// How many bytes the samples of a file can have.
struct Storage
{
    std::int64_t found = 0; ///< in the file, and those that it names
    bool packed = true;
    bool isRgba = false; ///< a MetaImage that says so: it has no field for that
    std::string unit;    ///< of lengths, where the format has another one than mm
    /// To LPS and mm, of a place that ITK leaves as the file has it: factors of x, y, z.
    glm::dvec3 turn{1.0};
};

std::int64_t sizeOf(const fs::path& path)
{
    std::error_code failed;
    const auto size = static_cast<std::int64_t>(fs::file_size(path, failed));
    return failed ? 0 : size;
}

std::string valueOf(std::string_view line)
{
    const std::size_t at = line.find_first_of(":=");
    std::string_view value = at == std::string_view::npos ? "" : line.substr(at + 1);
    while (!value.empty() &&
           (value.front() == ' ' || value.front() == '=' || value.front() == '\t'))
        value.remove_prefix(1);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\r'))
        value.remove_suffix(1);
    return std::string(value);
}

std::string lowered(std::string_view text)
{
    return osgDB::convertToLowerCase(std::string(text));
}

/// What ITK leaves of a NRRD's space on the way to LPS: it turns x of LAS, where y is to be, and
/// knows no spaces with time.
glm::dvec3 turnOf(const std::string& space)
{
    if (space == "left-anterior-superior" || space == "las") return {-1, -1, 1};
    if (space == "right-anterior-superior-time" || space == "rast") return {-1, -1, 1};
    if (space == "left-anterior-superior-time" || space == "last") return {1, -1, 1};
    return glm::dvec3(1.0);
}

/// Millimetres of a unit of length; 0 where it is none that is known.
double millimetresOf(const std::string& unit)
{
    struct Unit
    {
        const char* name;
        double millimetres;
    };
    constexpr Unit UNITS[] = {
        {"mm", 1.0},          {"millimeter", 1.0},  {"millimetre", 1.0},  {"cm", 10.0},
        {"centimeter", 10.0}, {"centimetre", 10.0}, {"m", 1000.0},        {"meter", 1000.0},
        {"metre", 1000.0},    {"um", 1e-3},         {"\xc2\xb5m", 1e-3},  {"\xce\xbcm", 1e-3},
        {"micron", 1e-3},     {"micrometer", 1e-3}, {"micrometre", 1e-3}, {"nm", 1e-6},
        {"nanometer", 1e-6},  {"nanometre", 1e-6},  {"angstrom", 1e-7}};
    std::string name = lowered(unit);
    for (const Unit& known : UNITS)
        if (name == known.name || name == std::string(known.name) + 's') return known.millimetres;
    return 0.0;
}

/// Of NRRD's quoted units, one for each axis: what is no length, as of time or colours, has none.
glm::dvec3 millimetresOfAll(const std::string& quoted)
{
    const std::vector<std::string_view> pieces = core::splitText(quoted, '"');
    std::vector<double> lengths;
    for (std::size_t i = 1; i < pieces.size(); i += 2)
        if (const double v = millimetresOf(std::string(pieces[i])); v > 0.0) lengths.push_back(v);
    if (lengths.size() == 3) return {lengths[0], lengths[1], lengths[2]};
    return glm::dvec3(lengths.empty() ? 1.0 : lengths.front());
}

// Of NRRD and MetaImage, whose headers are lines of text.
Storage storageOfText(const std::string& path, const std::string& head)
{
    Storage storage;
    storage.found = sizeOf(path);
    storage.packed = false;
    bool hasUnits = false;
    for (const std::string_view line : core::splitText(head, '\n')) {
        const auto is = [line](std::string_view field) {
            return lowered(line.substr(0, field.size())) == lowered(field);
        };
        if (line.empty()) break; // data of NRRD begin
        const std::string value = valueOf(line);
        if (is("encoding:")) storage.packed = value != "raw";
        if (is("CompressedData"))
            storage.packed = value == "True" || value == "true" || value == "1";
        if (is("space:")) storage.turn *= turnOf(lowered(value));
        const bool spaceUnits = is("space units:") || is("spaceunits:");
        if ((spaceUnits || is("units:")) && !hasUnits) {
            storage.turn *= millimetresOfAll(value);
            hasUnits = true;
        }
        if (is("DistanceUnits"))
            if (const double v = millimetresOf(value); v > 0.0) storage.turn *= v;
        if (is("Comment")) storage.isRgba = value == "RGBA";
        const bool names = is("data file:") || is("datafile:") || is("ElementDataFile");
        if (!names || value == "LOCAL" || value == "Local" || value == "local") continue;
        const fs::path folder = fs::path(path).parent_path();
        std::error_code failed;
        if (fs::path file = folder / value; fs::is_regular_file(file, failed)) {
            storage.found = sizeOf(file);
        } else { // a pattern, or a list: what the folder has at most
            for (fs::directory_iterator i(folder.empty() ? "." : folder, failed), end;
                 !failed && i != end; i.increment(failed))
                storage.found += sizeOf(i->path());
        }
        break;
    }
    return storage;
}

itk::SmartPointer<IO> ioFor(const std::string& path, Storage& storage)
{
    const std::string head = headOf(path, 1 << 16);
    const auto reads = [&path](IO& io) { return io.CanReadFile(path.c_str()); };
    if (const auto io = itk::NrrdImageIO::New(); reads(*io) && head.substr(0, 4) == "NRRD") {
        storage = storageOfText(path, head);
        return io.GetPointer();
    }
    if (const auto io = itk::MetaImageIO::New(); reads(*io)) {
        storage = storageOfText(path, head);
        return io.GetPointer();
    }
    storage = Storage();
    storage.found = sizeOf(path);
    storage.packed = false;
    storage.unit = "\xc3\xa5ngstr\xc3\xb6m";
    if (const auto io = itk::MRCImageIO::New(); reads(*io)) return io.GetPointer();
    storage.unit = "micrometre";
    if (const auto io = itk::BioRadImageIO::New(); reads(*io)) return io.GetPointer();
    storage.unit.clear();
    storage.packed = true;
    if (const auto io = itk::GiplImageIO::New(); reads(*io)) return io.GetPointer();
    if (ITK_VERSION_MAJOR == 5 && ITK_VERSION_MINOR < 4) storage.turn = glm::dvec3(-1, -1, 1);
    if (const auto io = itk::MINCImageIO::New(); reads(*io)) return io.GetPointer();
    return nullptr;
}

bool numberFor(Component component, Number& number)
{
    switch (component) {
    case Component::CHAR:
        number = Number::INT8;
        return true;
    case Component::UCHAR:
        number = Number::UINT8;
        return true;
    case Component::SHORT:
        number = Number::INT16;
        return true;
    case Component::USHORT:
        number = Number::UINT16;
        return true;
    case Component::INT:
        number = Number::INT32;
        return true;
    case Component::UINT:
        number = Number::UINT32;
        return true;
    case Component::LONG:
        number = sizeof(long) == 8 ? Number::INT64 : Number::INT32;
        return true;
    case Component::ULONG:
        number = sizeof(long) == 8 ? Number::UINT64 : Number::UINT32;
        return true;
    case Component::LONGLONG:
        number = Number::INT64;
        return true;
    case Component::ULONGLONG:
        number = Number::UINT64;
        return true;
    case Component::FLOAT:
        number = Number::FLOAT32;
        return true;
    case Component::DOUBLE:
        number = Number::FLOAT64;
        return true;
    default:
        return false;
    }
}

void placeSamples(const IO& io, Samples& s)
{
    const unsigned dimensions = std::min(io.GetNumberOfDimensions(), 3u);
    for (unsigned i = 0; i < dimensions; ++i) {
        const std::vector<double> direction = io.GetDirection(i);
        const int axis = static_cast<int>(i);
        s.axes[axis] = glm::dvec3(0.0);
        for (unsigned j = 0; j < dimensions; ++j)
            s.axes[axis][static_cast<int>(j)] = direction[j] * io.GetSpacing(i);
        s.position[axis] = io.GetOrigin(i);
    }
    if (dimensions == 2 && glm::length(glm::cross(s.axes[0], s.axes[1])) > 0.0)
        s.axes[2] = glm::normalize(glm::cross(s.axes[0], s.axes[1]));
}

Result<Samples> samplesOf(const IO& io, const std::string& path)
{
    Samples s;
    int size[4] = {1, 1, 1, 1};
    for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i) {
        const std::uint64_t n = io.GetDimensions(i);
        if (n < 1 || n > 0x7fffffffu || (i > 3 && n > 1))
            return Status(ErrorCode::NOT_SUPPORTED, path + " has " + std::to_string(n) +
                                                        " samples on axis " + std::to_string(i));
        if (i < 4) size[i] = static_cast<int>(n);
    }
    s.size = {size[0], size[1], size[2]};
    s.steps = size[3];
    s.channels = static_cast<int>(io.GetNumberOfComponents());
    s.colour = (io.GetPixelType() == Pixel::RGB && s.channels == 3) ||
               (io.GetPixelType() == Pixel::RGBA && s.channels == 4);
    if (!numberFor(io.GetComponentType(), s.number) || s.channels < 1)
        return Status(ErrorCode::NOT_SUPPORTED, path + " has numbers that no voxels are of");
    placeSamples(io, s);
    return s;
}

// The whole of a file into `s`.
Status readAll(IO& io, Samples& s, const std::string& path)
{
    if (Status status = s.allocate(); !status.ok()) return {status.code, path + ' ' + status.text};
    itk::ImageIORegion region(io.GetNumberOfDimensions());
    for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i) {
        region.SetIndex(i, 0);
        region.SetSize(i, io.GetDimensions(i));
    }
    io.SetIORegion(region);
    if (static_cast<std::int64_t>(io.GetImageSizeInBytes()) > s.bytes())
        return {ErrorCode::SIZE_MISMATCH, path + " has samples of two sizes"};
    io.Read(s.data.get());
    return {};
}

std::string reasonOf(const std::exception& e)
{
    const auto* itkError = dynamic_cast<const itk::ExceptionObject*>(&e);
    std::string text = itkError ? itkError->GetDescription() : e.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    // "ITK ERROR: MRCImageIO(0x558cf4248820): Unrecognized header"
    const std::size_t address = text.find("(0x"), end = text.find("): ");
    if (address != std::string::npos && end != std::string::npos && address < end)
        text.erase(0, end + 3);
    return text;
}

} // namespace

Result<Samples> readItkFile(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    static std::mutex mutex; // their errors are global
    const std::lock_guard<std::mutex> lock(mutex);
    itk::Object::SetGlobalWarningDisplay(false);
    try {
        Storage storage;
        const itk::SmartPointer<IO> io = ioFor(path, storage);
        if (!io)
            return Status(ErrorCode::FILE_UNREADABLE,
                          path + " is of none of the formats that its name stands for");
        io->SetFileName(path);
        io->ReadImageInformation();
        Result<Samples> samples = samplesOf(*io, path);
        if (!samples.ok()) return samples.status;
        samples->colour = samples->colour || (storage.isRgba && samples->channels == 4);
        for (glm::dvec3* v :
             {&samples->axes[0], &samples->axes[1], &samples->axes[2], &samples->position})
            *v *= storage.turn;
        if (Status status = checkBytes(path, storage.found, samples->bytes(), storage.packed);
            !status.ok())
            return status;
        if (!storage.unit.empty())
            samples->note = "its unit of length is the " + storage.unit +
                            ", as of all files of its format: one unit of the scene is one";
        if (Status status = readAll(*io, *samples, path); !status.ok()) return status;
        return samples;
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + reasonOf(e));
    }
}

} // namespace medical
} // namespace osgVolumizer
