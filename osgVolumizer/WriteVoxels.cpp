#include "WriteVoxels.h"

#include "core/RegularFile.h"
#include "core/voxels/VoxelData.h"
#include "io/MovedSource.h"
#include "io/OiioTypes.h"
#include "io/PageLayout.h"
#include "io/PartFile.h"
#include "io/PluginFile.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <vector>

namespace osgVolumizer {

namespace {

namespace fs = std::filesystem;
using io::oneLine;
using io::typeDescOf;

OIIO::ImageSpec specOf(const VoxelSource::Description& d)
{
    OIIO::ImageSpec spec(d.size.x, d.size.y, d.components, typeDescOf(d.type));
    spec.attribute("compression", "zip");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("ImageDescription", io::PageLayout::text(d));
    // What other programs read; this library reads the text.
    spec.attribute("XResolution", static_cast<float>(1.0 / d.spacing.x));
    spec.attribute("YResolution", static_cast<float>(1.0 / d.spacing.y));
    spec.attribute("ResolutionUnit", "none");
    // Offsets of a plain TIFF have 32 bits. Compression may fail to help, and pages have headers.
    if (d.sizeInBytes() > (std::int64_t(4) << 30) - (std::int64_t(256) << 20))
        spec.attribute("tiff:bigtiff", 1);
    return spec;
}

Status writeSlices(OIIO::ImageOutput& out, const VoxelSource& source, const std::string& part,
                   const std::string& name, const Progress& progress)
{
    const VoxelSource::Description d = source.describe();
    const OIIO::ImageSpec spec = specOf(d);
    std::vector<unsigned char> slice(
        static_cast<std::size_t>(core::voxelBytes({d.size.x, d.size.y, 1}, d.type, d.components)));
    for (int z = 0; z < d.size.z; ++z) {
        Status status = source.read({{0, 0, z}, {d.size.x, d.size.y, z + 1}}, slice.data());
        if (!status.ok()) return status;
        const auto mode = z ? OIIO::ImageOutput::AppendSubimage : OIIO::ImageOutput::Create;
        if (!out.open(part, spec, mode))
            return {ErrorCode::FILE_UNREADABLE,
                    name + " cannot be written: " + oneLine(out.geterror())};
        // A format that lacks a type takes another without a word; only a wider one keeps the
        // values.
        const bool widened =
            d.type == VoxelType::HALF && out.spec().format == OIIO::TypeDesc::FLOAT;
        if (out.spec().format != spec.format && !widened)
            return {ErrorCode::NOT_SUPPORTED,
                    name + ": the format cannot hold voxels of type " + voxelTypeName(d.type)};
        if (!out.write_image(spec.format, slice.data()))
            return {ErrorCode::FILE_UNREADABLE,
                    name + ": slice " + std::to_string(z) +
                        " cannot be written: " + oneLine(out.geterror())};
        if (progress) progress(static_cast<double>(z + 1) / d.size.z);
    }
    if (!out.close())
        return {ErrorCode::FILE_UNREADABLE,
                name + " cannot be written: " + oneLine(out.geterror())};
    return {};
}

} // namespace

Status writeVoxels(const Voxels& voxels, const std::string& fileName, const Progress& progress)
{
    if (!voxels.valid()) return {ErrorCode::VALUE_INVALID, fileName + ": no voxels to write"};
    const osg::ref_ptr<io::MovedSource> moved = new io::MovedSource(voxels);
    return writeVoxels(*moved, fileName, progress);
}

Status writeVoxels(const VoxelSource& source, const std::string& fileName, const Progress& progress)
{
    if (Status status = source.describe().validate(); !status.ok()) return status;
    if (Status status = core::requireRegularTarget(fileName); !status.ok()) return status;
    if (const auto writers = io::writersOf(fileName); !writers.empty()) {
        Status status = io::writeByPlugin(writers, source, fileName);
        if (status.ok() && progress) progress(1.0);
        return status;
    }
    try {
        OIIO::geterror();
        const auto out = OIIO::ImageOutput::create(fileName);
        if (!out)
            return {ErrorCode::NOT_SUPPORTED,
                    fileName +
                        " is of no format that is written: .tif, .nrrd, .nhdr, .nii, .nii.gz, "
                        ".mha, .mhd are, and images of several pages by OpenImageIO"};
        if (source.describe().size.z > 1 && !out->supports("appendsubimage"))
            return {ErrorCode::NOT_SUPPORTED,
                    fileName + ": the format \"" + out->format_name() + "\" cannot hold slices"};
        io::PartFile part(fileName);
        Status status = writeSlices(*out, source, part.name(), fileName, progress);
        return status.ok() ? part.keep() : status;
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, fileName + " cannot be written: " + oneLine(e.what())};
    }
}

} // namespace osgVolumizer
