#include "Dataset.h"

#include <algorithm>
#include <exception>
#include <limits>

namespace osgVolumizer {
namespace hdf5 {

namespace {

/// Broken files have numbers of millions of bytes, on which the library crashes.
constexpr std::size_t MAXIMUM_NUMBER_BYTES = 16;
/// A piece is unpacked as a whole; what claims more per piece is broken, or would not do for
/// paging.
constexpr double MAXIMUM_PIECE_BYTES = 1 << 30;

const char* className(H5T_class_t type)
{
    switch (type) {
    case H5T_STRING:
        return "strings";
    case H5T_COMPOUND:
        return "compound values";
    case H5T_REFERENCE:
        return "references";
    case H5T_ARRAY:
        return "arrays";
    case H5T_VLEN:
        return "lists";
    case H5T_BITFIELD:
        return "bits";
    default:
        return "opaque values";
    }
}

// The voxel type that holds all numbers of a type, or the nearest.
void setNumericType(hid_t type, Dataset& dataset)
{
    const std::size_t bytes = H5Tget_size(type);
    const std::string bits = std::to_string(8 * bytes);
    dataset.numeric = bytes <= MAXIMUM_NUMBER_BYTES;
    if (H5Tget_class(type) == H5T_FLOAT) {
        dataset.typeName = "float" + bits;
        dataset.type = VoxelType::FLOAT32;
        dataset.rounded = bytes > 4;
        return;
    }
    const bool hasSign = H5Tget_sign(type) != H5T_SGN_NONE;
    dataset.typeName = (hasSign ? "int" : "uint") + bits;
    dataset.rounded = bytes > 4;
    if (bytes > 4)
        dataset.type = VoxelType::FLOAT32;
    else if (bytes > 2)
        dataset.type = hasSign ? VoxelType::INT32 : VoxelType::UINT32;
    else if (bytes > 1)
        dataset.type = hasSign ? VoxelType::INT16 : VoxelType::UINT16;
    else
        dataset.type = hasSign ? VoxelType::INT8 : VoxelType::UINT8;
}

void setType(hid_t type, Dataset& dataset)
{
    const H5T_class_t kind = H5Tget_class(type);
    if (kind == H5T_INTEGER || kind == H5T_FLOAT) {
        setNumericType(type, dataset);
    } else if (kind == H5T_ENUM) { // masks of h5py are
        const Handle base(H5Tget_super(type), H5Tclose);
        setNumericType(base, dataset);
    } else {
        dataset.typeName = className(kind);
    }
}

// Whether what it is compressed with can be undone.
Status checkFilters(hid_t properties, const std::string& path)
{
    const int count = H5Pget_nfilters(properties);
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        char name[64] = "";
        const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags,
                                                   &values, nullptr, sizeof(name), name, &config);
        if (filter < 0 || flags & H5Z_FLAG_OPTIONAL || H5Zfilter_avail(filter) > 0) continue;
        name[sizeof(name) - 1] = 0;
        return {ErrorCode::NOT_SUPPORTED,
                "dataset " + oneLine(path) + " is packed by filter " + std::to_string(filter) +
                    (name[0] ? " (" + oneLine(name) + ")" : "") +
                    ", which this HDF5 library lacks: see HDF5_PLUGIN_PATH"};
    }
    return {};
}

Status checkPieces(hid_t properties, std::size_t voxel, const std::string& path)
{
    if (H5Pget_layout(properties) != H5D_CHUNKED) return {};
    hsize_t size[H5S_MAX_RANK] = {};
    const int rank = H5Pget_chunk(properties, H5S_MAX_RANK, size);
    double bytes = static_cast<double>(voxel);
    for (int axis = 0; axis < rank; ++axis)
        bytes *= static_cast<double>(size[axis]);
    if (bytes <= MAXIMUM_PIECE_BYTES) return {};
    return {ErrorCode::TOO_LARGE,
            "dataset " + oneLine(path) + " is stored in pieces of " +
                std::to_string(static_cast<std::int64_t>(bytes / (1 << 20))) +
                " MB, more than the bound of " +
                std::to_string(static_cast<std::int64_t>(MAXIMUM_PIECE_BYTES / (1 << 20)))};
}

herr_t keepDataset(hid_t, const char* name, const H5O_info_t* info, void* paths)
{
    try {
        if (info->type == H5O_TYPE_DATASET)
            static_cast<std::vector<std::string>*>(paths)->push_back(std::string("/") + name);
        return 0;
    } catch (const std::exception&) {
        return -1;
    }
}

// Size and type, as far as they can be had.
std::optional<Dataset> describe(hid_t id, const std::string& path)
{
    const Handle space(H5Dget_space(id), H5Sclose), type(H5Dget_type(id), H5Tclose);
    if (!space.ok() || !type.ok()) return std::nullopt;
    Dataset dataset;
    dataset.path = path;
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0) return std::nullopt;
    dataset.size.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, dataset.size.data(), nullptr);
    setType(type, dataset);
    return dataset;
}

} // namespace

std::string Dataset::text() const
{
    std::string sizes;
    for (const hsize_t n : size)
        sizes += (sizes.empty() ? "" : ",") + std::to_string(n);
    return oneLine(path) + " (" + (sizes.empty() ? "one" : sizes) + " of " + typeName + ")";
}

Result<Dataset> inspect(hid_t file, const std::string& path)
{
    const Session session;
    const Handle id(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    const std::optional<Dataset> dataset = id.ok() ? describe(id, path) : std::optional<Dataset>();
    if (!dataset)
        return Status(ErrorCode::FILE_UNREADABLE,
                      "dataset " + oneLine(path) + " cannot be read" + session.reason());
    const Handle properties(H5Dget_create_plist(id), H5Pclose), type(H5Dget_type(id), H5Tclose);
    // What lies in other files may be no files, and nobody would see that they are cut short.
    if (H5Pget_external_count(properties) > 0 || H5Pget_layout(properties) == H5D_VIRTUAL)
        return Status(ErrorCode::NOT_SUPPORTED,
                      "dataset " + oneLine(path) + " has its values in other files");
    if (Status status = checkFilters(properties, path); !status.ok()) return status;
    if (Status status = checkPieces(properties, H5Tget_size(type), path); !status.ok())
        return status;
    return *dataset;
}

Result<std::vector<Dataset>> listDatasets(hid_t file)
{
    const Session session;
    std::vector<std::string> paths;
    if (H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, keepDataset, &paths) < 0)
        return Status(ErrorCode::FILE_UNREADABLE, "its groups cannot be read" + session.reason());
    std::vector<Dataset> datasets;
    for (const std::string& path : paths) {
        const Handle id(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
        if (!id.ok()) continue;
        if (std::optional<Dataset> dataset = describe(id, path))
            datasets.push_back(std::move(*dataset));
    }
    return datasets;
}

std::optional<Axes> axesOf(const Dataset& dataset)
{
    int first = 0, end = static_cast<int>(dataset.size.size());
    const auto isOne = [&dataset](int axis) { return dataset.size[std::size_t(axis)] == 1; };
    while (end - first > 3 && isOne(end - 1))
        --end;
    while (end - first > 3 && isOne(first))
        ++first;
    if (end - first == 3) return Axes{first, -1};
    if (end - first == 4) return Axes{first + 1, first};
    return std::nullopt;
}

Result<glm::ivec3> voxelSize(const Dataset& dataset, int axis)
{
    glm::ivec3 size(0);
    for (int i = 0; i < 3; ++i) {
        const hsize_t samples = dataset.size[std::size_t(axis + i)];
        if (samples == 0)
            return Status(ErrorCode::VALUE_INVALID,
                          "dataset " + dataset.text() + " has no samples");
        if (samples > hsize_t(std::numeric_limits<int>::max()))
            return Status(ErrorCode::TOO_LARGE, "dataset " + dataset.text() +
                                                    " has more than 2147483647 samples on an axis");
        size[2 - i] = static_cast<int>(samples);
    }
    return size;
}

Status checkVolume(const Dataset& dataset)
{
    if (!dataset.numeric)
        return {ErrorCode::NOT_SUPPORTED, "dataset " + dataset.text() + " holds no numbers"};
    if (axesOf(dataset)) return {};
    return {ErrorCode::NOT_SUPPORTED,
            "dataset " + dataset.text() + " has neither the axes z,y,x nor time,z,y,x"};
}

Status checkLevel(const Dataset& dataset)
{
    if (!dataset.numeric || dataset.size.size() == 3) return checkVolume(dataset);
    return {ErrorCode::NOT_SUPPORTED, "dataset " + dataset.text() + " has other axes than z,y,x"};
}

} // namespace hdf5
} // namespace osgVolumizer
