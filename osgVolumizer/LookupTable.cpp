#include "LookupTable.h"

#include <cmath>

namespace osgVolumizer {

namespace {

std::atomic<unsigned> lastCount{0};

} // namespace

LookupTable::LookupTable()
    : _function(std::make_shared<core::TransferFunction>()), _modifiedCount(++lastCount)
{
}

LookupTable::LookupTable(const LookupTable& o, const osg::CopyOp& op)
    : osg::Object(o, op), _modifiedCount(++lastCount), _fileName(o._fileName),
      _filePath(o._filePath)
{
    std::lock_guard<std::mutex> lock(o._mutex);
    _function = o._function;
    _domain = o._domain;
}

void LookupTable::assign(core::TransferFunction function, Domain domain)
{
    auto fresh = std::make_shared<const core::TransferFunction>(std::move(function));
    std::lock_guard<std::mutex> lock(_mutex);
    _function = std::move(fresh);
    _domain = domain;
    _modifiedCount = ++lastCount;
}

ReportedStatus LookupTable::setPoints(LookupPoints points, Domain domain)
{
    if (domain != RANGE_FRACTION && domain != DATA_VALUES)
        return reported(
            {ErrorCode::VALUE_INVALID,
             "lookup table domain " + std::to_string(static_cast<int>(domain)) + " is unknown"});
    Result<core::TransferFunction> function = core::TransferFunction::create(std::move(points));
    if (!function.ok()) return reported(function.status);
    assign(std::move(*function), domain);
    return {};
}

ReportedStatus LookupTable::setEntries(const std::vector<osg::Vec4>& entries)
{
    std::vector<glm::dvec4> colors;
    colors.reserve(entries.size());
    for (const osg::Vec4& e : entries)
        colors.emplace_back(static_cast<double>(e.r()), static_cast<double>(e.g()),
                            static_cast<double>(e.b()), static_cast<double>(e.a()));
    Result<core::TransferFunction> function = core::TransferFunction::createUniform(colors);
    if (!function.ok()) return reported(function.status);
    assign(std::move(*function), RANGE_FRACTION);
    return {};
}

ReportedStatus LookupTable::setRamp(double centre, double width, const osg::Vec3& color,
                                    double maximumOpacity)
{
    const glm::dvec4 full(static_cast<double>(color.x()), static_cast<double>(color.y()),
                          static_cast<double>(color.z()), maximumOpacity);
    const double half = 0.5 * std::fabs(width);
    core::TransferFunction::Point low{centre - half, glm::dvec4(0.0)};
    core::TransferFunction::Point high{centre + half, full};
    if (width < 0.0) std::swap(low.color, high.color);
    return setPoints({low, high}, RANGE_FRACTION);
}

LookupTable::Function LookupTable::getFunction() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _function;
}

LookupTable::Domain LookupTable::getDomain() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _domain;
}

LookupTable::Function LookupTable::getNormalizedFunction(const osg::Vec2d& range) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    const double scale = 1.0 / (range.y() - range.x());
    if (_domain == RANGE_FRACTION || !(scale > 0.0) || !std::isfinite(scale)) return _function;
    return std::make_shared<core::TransferFunction>(_function->mapped(scale, -range.x() * scale));
}

} // namespace osgVolumizer
