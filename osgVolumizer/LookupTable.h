#pragma once

#include "core/Export.h"
#include "core/transfer/TransferFunction.h"

#include <osg/Object>
#include <osg/Vec2d>
#include <osg/Vec3>
#include <osg/Vec4>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace osgVolumizer {

/// Colour and opacity of a value. Points lie either on the fraction [0,1] of the voxels' range, or at
/// data values. May be changed between frames from the application's thread; each change replaces an
/// immutable function, so that a cull or draw under way keeps the one it has.
class OSGVOLUMIZER_EXPORT LookupTable : public osg::Object
{
public:
    META_Object(osgVolumizer, LookupTable)

    enum Domain { RANGE_FRACTION, DATA_VALUES };
    using Function = std::shared_ptr<const core::TransferFunction>;

    /// A white ramp over the whole range.
    LookupTable();
    LookupTable(const LookupTable& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// See core::TransferFunction::create for what is refused; the table then keeps what it had.
    Status setPoints(std::vector<core::TransferFunction::Point> points, Domain domain);
    /// Entry i of n at i/(n-1) of the range.
    Status setEntries(const std::vector<osg::Vec4>& entries);
    /// Opacity (and brightness) rising from 0 to 1 over `width` about `centre`, both fractions of the
    /// range; a negative width makes it fall.
    Status setRamp(double centre, double width, const osg::Vec3& color = osg::Vec3(1, 1, 1),
                   double maximumOpacity = 1.0);

    Function getFunction() const;
    Domain getDomain() const { return _domain; }
    /// The function over the fraction of `range` (data values), whatever the domain.
    Function getNormalizedFunction(const osg::Vec2d& range) const;
    /// Grows with every change. Thread safe.
    unsigned getModifiedCount() const { return _modifiedCount; }

    /// How a scene file refers to the table; empty: inline.
    void setFileName(const std::string& name) { _fileName = name; }
    const std::string& getFileName() const { return _fileName; }

protected:
    ~LookupTable() override = default;

private:
    mutable std::mutex _mutex;
    Function _function;
    std::atomic<Domain> _domain{RANGE_FRACTION};
    std::atomic<unsigned> _modifiedCount{0};
    std::string _fileName;
};

/// Reads a `.lut` (plain text, "value r g b a" per line in data values, '#' starts a comment) or OSG's `.tf`.
/// The error names file, line and value.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<LookupTable>> readLookupTable(const std::string& fileName);
/// Parses the text of a `.lut`; `name` is for messages.
OSGVOLUMIZER_EXPORT Result<std::vector<core::TransferFunction::Point>>
parseLookupTable(const std::string& text, const std::string& name);
OSGVOLUMIZER_EXPORT Status writeLookupTable(const LookupTable& table, const std::string& fileName);

} // namespace osgVolumizer
