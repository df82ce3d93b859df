#include "NiftiHeader.h"
#include "NumberFile.h"

#include <osgDB/FileNameUtils>

#include <filesystem>

namespace osgVolumizer {
namespace medical {

namespace {

bool endsIn(const std::string& name, const std::string& end)
{
    return name.size() > end.size() &&
           osgDB::convertToLowerCase(name).compare(name.size() - end.size(), end.size(), end) == 0;
}

std::string without(const std::string& path)
{
    const std::string name = endsIn(path, ".gz") ? path.substr(0, path.size() - 3) : path;
    return name.substr(0, name.size() - 4);
}

// The one of several names that is there; else the first.
std::string existing(const std::string& stem, const std::vector<std::string>& ends)
{
    std::error_code ignored;
    for (const std::string& end : ends)
        if (std::filesystem::exists(stem + end, ignored)) return stem + end;
    return stem + ends.front();
}

} // namespace

Result<Samples> readNifti(const std::string& name)
{
    std::string path = name;
    if (endsIn(path, ".nia"))
        return Status(ErrorCode::NOT_SUPPORTED, path + " is NIfTI as text, which cannot be read");
    if (endsIn(path, ".img") || endsIn(path, ".img.gz"))
        path = existing(without(path), {".hdr", ".hdr.gz"});
    Result<NiftiHeader> header = NiftiHeader::parse(headOf(path, NiftiHeader::MOST_BYTES));
    if (!header.ok()) return Status(header.status.code, path + ' ' + header.status.text);
    if (header->detached)
        path = endsIn(name, ".img") || endsIn(name, ".img.gz")
                   ? name
                   : existing(without(path), {".img", ".img.gz"});
    std::error_code ignored;
    if (header->detached && std::filesystem::exists(without(path) + ".mat", ignored))
        header->samples.note = "the transform in " + without(path) + ".mat is not applied";
    if (Status status = readNumbers(path, header->offset, header->swapped, header->samples);
        !status.ok())
        return status;
    return header->samples;
}

} // namespace medical
} // namespace osgVolumizer
