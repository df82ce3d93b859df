#include "File.h"

#include "ClassicFile.h"
#include "Session.h"

#include <osgVolumizer/core/RegularFile.h>

#include <algorithm>
#include <filesystem>

namespace osgVolumizer {
namespace gdal {

namespace {

namespace fs = std::filesystem;

// The path as GDAL is to take it: no name that stands for something else, "NETCDF:...".
Result<std::string> localPath(const std::string& path)
{
    std::error_code unknown;
    if (!fs::is_directory(path, unknown)) {
        if (Status status = core::requireRegularFile(path); !status.ok()) return status;
        if (Status status = checkClassicFile(path); !status.ok()) return status;
    }
    const std::string absolute = fs::absolute(path).string();
    if (absolute.rfind("/vsi", 0) == 0)
        return Status(ErrorCode::NOT_SUPPORTED,
                      path + " has a name that GDAL takes for no file of this system");
    return absolute;
}

std::vector<const char*> driversFor(const std::string& path)
{
    std::error_code unknown;
    if (fs::is_directory(path, unknown)) return {"Zarr"};
    return {"netCDF", "HDF5"};
}

} // namespace

Result<std::shared_ptr<const File>> File::open(const std::string& path)
{
    const Result<std::string> local = localPath(path);
    if (!local.ok()) return local.status;
    const Session session;
    std::shared_ptr<File> file(new File);
    file->_path = path;
    bool present = false, opened = false;
    std::string reason;
    for (const char* driver : driversFor(path)) {
        if (!GetGDALDriverManager()->GetDriverByName(driver)) continue;
        present = true;
        const char* const drivers[] = {driver, nullptr};
        file->_driver = driver;
        file->_dataset = GDALDataset::Open(
            local->c_str(), GDAL_OF_MULTIDIM_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
            drivers, nullptr, nullptr);
        if (file->_dataset) file->_variables = variablesOf(file->_dataset->GetRootGroup());
        if (!file->_variables.empty()) return std::shared_ptr<const File>(file);
        // What a driver says that cannot open what another can does not matter.
        if (file->_dataset || !opened) reason = session.reason();
        opened = opened || file->_dataset;
        if (file->_dataset) GDALClose(GDALDataset::ToHandle(file->_dataset));
        file->_dataset = nullptr;
    }
    if (!present)
        return Status(ErrorCode::NOT_SUPPORTED,
                      path + " is of a format that this build of GDAL has no driver for");
    return Status(ErrorCode::FILE_UNREADABLE,
                  path + (reason.empty() ? " has no volume: no variable of numbers with two axes"
                                         : " cannot be read" + reason));
}

File::~File()
{
    const Session session;
    _variables.clear();
    if (_dataset) GDALClose(GDALDataset::ToHandle(_dataset));
}

std::string File::names() const
{
    constexpr std::size_t MOST = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(_variables.size(), MOST); ++i)
        text += (i ? ", " : "") + oneLine(_variables[i].path);
    return _variables.size() > MOST ? text + ", ..." : text;
}

Result<std::size_t> File::choose(const std::string& name) const
{
    if (name.empty()) {
        const auto rank = [](const Variable& v) {
            return std::pair(v.longAxes() > 2, v.array->GetTotalElementsCount());
        };
        const auto largest = std::max_element(
            _variables.begin(), _variables.end(),
            [&](const Variable& a, const Variable& b) { return rank(a) < rank(b); });
        return std::size_t(largest - _variables.begin());
    }
    const std::string end = (name[0] == '/' ? "" : "/") + name;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < _variables.size(); ++i) {
        const std::string& path = _variables[i].path;
        if (path == end) return i;
        if (path.size() > end.size() &&
            path.compare(path.size() - end.size(), end.size(), end) == 0)
            found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    return Status(ErrorCode::VALUE_INVALID,
                  _path + " has " + (found.empty() ? "no" : "more than one") + " variable \"" +
                      name + "\" that is a volume: there are " + names());
}

} // namespace gdal
} // namespace osgVolumizer
