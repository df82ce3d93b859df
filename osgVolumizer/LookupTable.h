#pragma once

#include "Error.h"
#include "RenderData.h"
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

namespace osgDB {
class Options;
}

namespace osgVolumizer {

using LookupPoints = std::vector<core::TransferFunction::Point>;

/// Colour and opacity of a value. Points lie either on the fraction [0,1] of the voxels' range, or
/// at data values. May be changed between frames from the application's thread; each change
/// replaces an immutable function, so that a cull or draw under way keeps the one it has.
class OSGVOLUMIZER_EXPORT LookupTable : public osg::Object
{
public:
    META_Object(osgVolumizer, LookupTable);

    enum Domain
    {
        RANGE_FRACTION,
        DATA_VALUES
    };
    using Function = std::shared_ptr<const core::TransferFunction>;

    /// A white ramp over the whole range: setRamp(0.5, 1).
    LookupTable();
    /// A table of its own, whatever the flags.
    LookupTable(const LookupTable& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// See core::TransferFunction::create for what is refused; the table then keeps what it had.
    ReportedStatus setPoints(LookupPoints points, Domain domain);
    /// Entry i of n at i/(n-1) of the range.
    ReportedStatus setEntries(const std::vector<osg::Vec4>& entries);
    /// Opacity (and brightness) rising from 0 to 1 over `width` about `centre`, both fractions of
    /// the range; a negative width makes it fall, none makes it jump.
    ReportedStatus setRamp(double centre, double width, const osg::Vec3& color = osg::Vec3(1, 1, 1),
                           double maximumOpacity = 1.0);

    Function getFunction() const;
    Domain getDomain() const;
    /// The function over the fraction of `range` (data values, low < high), whatever the domain.
    Function getNormalizedFunction(const osg::Vec2d& range) const;
    /// Grows with every change, to a number that no other table has had. Thread safe.
    unsigned getModifiedCount() const { return _modifiedCount; }

    /// The name by which a scene file refers to the table, which it holds itself where this is
    /// empty.
    void setFileName(const std::string& name) { _fileName = name; }
    const std::string& getFileName() const { return _fileName; }
    /// Where that file was found, as an absolute name; empty where that is not known.
    /// readLookupTable() sets it; a scene file in another folder refers to it.
    void setFilePath(const std::string& path) { _filePath = path; }
    const std::string& getFilePath() const { return _filePath; }

protected:
    ~LookupTable() override = default;

private:
    friend struct RenderDataAccess;
    void assign(core::TransferFunction function, Domain domain);

    mutable std::mutex _mutex; // of the next two
    Function _function;
    Domain _domain = RANGE_FRACTION;
    std::atomic<unsigned> _modifiedCount;
    std::string _fileName, _filePath;
    mutable RenderDataSlot _renderData; // textures, shared by all appearances that have the table
};

/// Reads a `.lut` (plain text, "value r g b a" per line in data values, '#' starts a comment) or
/// OSG's `.tf` (the same, components 0 to 255 unless a line "colour-scale n" says otherwise, in any
/// order). Found along OSG's data path. The error names file, line and value, or, with
/// NOT_SUPPORTED, the format of another program that the file seems to have; files above 64 MiB,
/// and what is no regular file, are refused.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<LookupTable>>
readLookupTable(const std::string& fileName, const osgDB::Options* options = nullptr);

/// Parses the text of a `.lut`; `name` is for messages.
OSGVOLUMIZER_EXPORT Result<LookupPoints> parseLookupTable(const std::string& text,
                                                          const std::string& name);
/// Parses the text of a `.tf`.
OSGVOLUMIZER_EXPORT Result<LookupPoints> parseTransferFunctionFile(const std::string& text,
                                                                   const std::string& name);

/// Writes a `.lut`. A table over the fraction of the range is written in data values for `range`.
OSGVOLUMIZER_EXPORT Status writeLookupTable(const LookupTable& table, const std::string& fileName,
                                            const osg::Vec2d& range = osg::Vec2d(0.0, 1.0));

} // namespace osgVolumizer
