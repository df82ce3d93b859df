#include "FileHead.h"

#include <osgVolumizer/core/RegularFile.h>

#include <osgDB/FileNameUtils>

#include <fstream>

namespace osgVolumizer {
namespace vtkimage {

Status notAVolume(const std::string& kind)
{
    const std::string k = osgDB::convertToLowerCase(kind);
    if (k == "unstructured_grid" || k == "unstructuredgrid")
        return {ErrorCode::NOT_SUPPORTED, "holds an unstructured grid, which is read as cells and "
                                          "not as voxels: open the file itself, without .volume"};
    return {ErrorCode::NOT_SUPPORTED,
            "holds a data set of VTK's kind \"" + kind +
                "\"; images (structured points), rectilinear grids and, by their own names, "
                "unstructured grids can be read"};
}

Result<FileHead> readHead(const std::string& path)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    char first = 0;
    std::ifstream(path, std::ios::binary).get(first);
    Result<FileHead> head = first == '#' ? readLegacyHead(path) : readXmlHead(path);
    if (head.ok()) return head;
    return Status(head.status.code,
                  path + (head.status.code == ErrorCode::NOT_SUPPORTED ? " " : ": ") +
                      head.status.text);
}

} // namespace vtkimage
} // namespace osgVolumizer
