#include "FileReference.h"
#include "Objects.h"
#include "RecordProperty.h"

#include <osgVolumizer/EditableVoxelSource.h>
#include <osgVolumizer/Error.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/Voxels.h>

#include <osgDB/Registry>

namespace osgVolumizer {
namespace serializers {
namespace {

// Whether the file that the voxels are from has others by now.
bool isChanged(const Voxels& voxels)
{
    const auto* source = dynamic_cast<const EditableVoxelSource*>(voxels.getSource());
    return source && source->isChanged();
}

// Voxels with a file name are written by that name; others, those that have been changed, and where
// the scene is to hold all of itself, with their source, but for what is read piece by piece since
// it is too large.
bool isReferred(const Voxels& voxels, const osgDB::OutputStream& os)
{
    const bool small = voxels.getSource() && !voxels.isPaged();
    return !voxels.getFileName().empty() && !isChanged(voxels) && !(isEmbedding(os) && small);
}

bool readSource(osgDB::InputStream& is, Voxels& voxels)
{
    const osg::ref_ptr<VoxelSource> source = readObject<VoxelSource>(is);
    const CallerReports withName;
    // A source without voxels was damaged, and that is reported already.
    if (source && source->describe().size.x > 0)
        reportReadError(is, voxels, voxels.setSource(source.get()));
    return true;
}

bool isSerializable(const VoxelSource& source)
{
    const std::string name = std::string(source.libraryName()) + "::" + source.className();
    return osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(name) != nullptr;
}

// The voxels of a source that has no form in a scene file, such as a file's.
Status copyToMemory(const VoxelSource& source, MemoryVoxelSource& copy)
{
    if (source.levelCount() > 1 || source.stepCount() > 1)
        return {
            ErrorCode::NOT_SUPPORTED,
            "voxels of " + std::string(source.className()) +
                ", which are read piece by piece, have neither the name of a file nor a wrapper "
                "of their class for scene files"};
    const VoxelSource::Description description = source.describe();
    const CallerReports withReason;
    const Status status = copy.allocate(description);
    return status.ok() ? source.read({glm::ivec3(0), description.size}, copy.data()) : status;
}

// Where they cannot be, the scene is not written: it would be without them.
bool writeSource(osgDB::OutputStream& os, const Voxels& voxels)
{
    const VoxelSource& source = *voxels.getSource();
    if (isSerializable(source)) {
        writeObject(os, &source);
        return true;
    }
    const osg::ref_ptr<MemoryVoxelSource> copy = new MemoryVoxelSource;
    const Status status = copyToMemory(source, *copy);
    if (!status.ok()) {
        reportError({status.code, "the scene is not written: " + status.text});
        os.throwException("osgVolumizer: " + status.text);
        return false;
    }
    writeObject(os, copy.get());
    return true;
}

// As osgDB::UserSerializer, but whether there is a source to write depends on the stream.
class SourceSerializer : public osgDB::UserSerializer<Voxels>
{
public:
    SourceSerializer() : osgDB::UserSerializer<Voxels>("Source", nullptr, readSource, writeSource)
    {
    }
    bool write(osgDB::OutputStream& os, const osg::Object& object) override
    {
        const auto& voxels = static_cast<const Voxels&>(object);
        const bool written = voxels.getSource() && !isReferred(voxels, os);
        if (os.isBinary())
            os << written;
        else if (written)
            os << os.PROPERTY("Source");
        return !written || writeSource(os, voxels);
    }
};

osg::Vec3d vector(const Field::Doubles& v)
{
    return osg::Vec3d(v[0], v[1], v[2]);
}

Status readFile(const Record& record, const osgDB::Options* options, Voxels& voxels)
{
    std::string name, fileOptions;
    Status status = record.get("FileName", name);
    if (status.ok()) status = record.get("FileOptions", fileOptions);
    if (!status.ok()) return status;
    voxels.setFileName(name);
    voxels.setFileOptions(fileOptions);
    osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
    local->setOptionString(fileOptions);
    const auto read = readVoxels(name, local.get());
    if (!read.ok()) return read.status;
    voxels.setFilePath((*read)->getFilePath());
    status = voxels.setSource((*read)->getSource());
    if (status.ok() && (*read)->hasExplicitRange()) status = voxels.setRange((*read)->getRange());
    return status;
}

Status readBrickSizes(const Record& record, Voxels& voxels)
{
    Field::Integers size;
    int overlap = 1;
    Status status = record.get("BrickSize", 3, size);
    for (int i = 0; i < 3 && status.ok(); ++i)
        if (size[std::size_t(i)] < 1 || size[std::size_t(i)] > 2147483647)
            status = Status(ErrorCode::VALUE_INVALID,
                            "field BrickSize, value " + std::to_string(i) + " is " +
                                std::to_string(size[std::size_t(i)]),
                            i);
    if (status.ok()) status = record.getInteger("Overlap", 0, 1024, overlap);
    // The bricks that there are may be too small for the new overlap, or the new ones for the old.
    if (status.ok() && overlap < voxels.getOverlap()) status = voxels.setOverlap(overlap);
    if (status.ok()) status = voxels.setBrickSize({int(size[0]), int(size[1]), int(size[2])});
    return status.ok() ? voxels.setOverlap(overlap) : status;
}

// Since version 5, and only where they are not smaller than the others.
Status readPartialBricks(const Record& record, Voxels& voxels)
{
    int partial = 0;
    if (!record.has("PartialBricks")) return Status();
    const Status status = record.getInteger("PartialBricks", 0, 2, partial);
    return status.ok() ? voxels.setPartialBricks(static_cast<core::PartialBricks>(partial))
                       : status;
}

Status readSpacing(const Record& record, Voxels& voxels)
{
    Field::Doubles values;
    const Status status = record.get("Spacing", 3, values);
    return status.ok() ? voxels.setSpacing(vector(values)) : status;
}

Status readOrigin(const Record& record, Voxels& voxels)
{
    Field::Doubles values;
    const Status status = record.get("Origin", 3, values);
    return status.ok() ? voxels.setOrigin(vector(values)) : status;
}

Status readRange(const Record& record, Voxels& voxels)
{
    if (!record.has("Range")) return Status();
    Field::Doubles values;
    const Status status = record.get("Range", 2, values);
    return status.ok() ? voxels.setRange(osg::Vec2d(values[0], values[1])) : status;
}

// Since version 5, and only where there is one.
Status readTextureBudget(const Record& record, Voxels& voxels)
{
    Field::Integers bytes;
    if (!record.has("TextureBudget")) return Status();
    const Status status = record.get("TextureBudget", 1, bytes);
    return status.ok() ? voxels.setTextureBudget(bytes[0]) : status;
}

// Each field by itself, as of an appearance; without the file there is nothing to apply them to.
Status applyBricks(Record& record, const osgDB::Options* options, Voxels& voxels)
{
    Status status;
    if (record.has("FileName")) status = readFile(record, options, voxels);
    if (!status.ok()) return status;
    for (const auto& read : {readBrickSizes, readPartialBricks, readSpacing, readOrigin, readRange,
                             readTextureBudget}) {
        const Status set = read(record, voxels);
        if (status.ok()) status = set;
    }
    return status;
}

void fillBricks(const Voxels& voxels, Record& record, const osgDB::OutputStream& os)
{
    const osg::Vec3i size = voxels.getBrickSize();
    const osg::Vec3d spacing = voxels.getSpacing(), origin = voxels.getOrigin();
    if (isReferred(voxels, os)) {
        record.add("FileName", referenceFrom(os, voxels.getFileName(), voxels.getFilePath()));
        record.add("FileOptions", voxels.getFileOptions());
    }
    record.add("BrickSize", Field::Integers{size.x(), size.y(), size.z()});
    record.add("Overlap", Field::Integers{voxels.getOverlap()});
    if (voxels.getPartialBricks() != core::PartialBricks::SHRINK_TO_FIT)
        record.add("PartialBricks", Field::Integers{static_cast<int>(voxels.getPartialBricks())});
    record.add("Spacing", Field::Doubles{spacing.x(), spacing.y(), spacing.z()});
    record.add("Origin", Field::Doubles{origin.x(), origin.y(), origin.z()});
    // What was found in the data before they changed is what their table is for.
    if (voxels.hasExplicitRange() || isChanged(voxels))
        record.add("Range", Field::Doubles{voxels.getRange().x(), voxels.getRange().y()});
    if (voxels.getTextureBudget() != 0)
        record.add("TextureBudget", Field::Integers{voxels.getTextureBudget()});
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_Voxels, new osgVolumizer::Voxels, osgVolumizer::Voxels,
                        "osg::Object osgVolumizer::Voxels")
{
    wrapper->addSerializer(new SourceSerializer, osgDB::BaseSerializer::RW_USER);
    addRecordProperty<MyClass, &applyBricks, &fillBricks>(*wrapper, "Bricks");
}
