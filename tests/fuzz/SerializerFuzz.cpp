// Any bytes as the record of a volume's object in a scene file, text or binary: read, or refused
// with a reason, and whatever is read is valid. The first byte chooses format and class.
#include <osgVolumizer/Error.h>
#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/VoxelSource.h>

#include <osgDB/Registry>

#include <cstdlib>
#include <sstream>
#include <string>

using namespace osgVolumizer;

namespace {

struct Quiet : osg::NotifyHandler
{
    void notify(osg::NotifySeverity, const char*) override {}
};

osgDB::ReaderWriter* readerWriter()
{
    static osgDB::ReaderWriter* const instance = [] {
        osg::setNotifyHandler(new Quiet);
        return osgDB::Registry::instance()->getReaderWriterForExtension("osgt");
    }();
    return instance;
}

osg::ref_ptr<osg::Object> makeObject(int which)
{
    if (which == 0) return new VolumeGeometry;
    if (which == 1) return new LookupTable;
    if (which == 2) return new VolumeAppearance;
    VoxelSource::Description d;
    d.size = glm::ivec3(1);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    if (!source->allocate(d).ok()) std::abort();
    return source;
}

// A file up to where the record's fields begin.
std::string prefix(int which, bool binary)
{
    static const char* const records[] = {"TetraSet", "Function", "Sampling", "Data"};
    const osg::ref_ptr<osg::Object> object = makeObject(which);
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    if (!binary) options->setPluginStringData("fileType", "Ascii");
    std::stringstream file;
    if (!readerWriter()->writeObject(*object, file, options.get()).success()) std::abort();
    const std::string content = file.str();
    if (!binary) {
        const std::string name = std::string(records[which]) + " {";
        return content.substr(0, content.find(name) + name.size()) + "\n";
    }
    // Before the first field's name: its length, the number of fields, the number of bytes.
    return content.substr(0, content.find("Version") - 4 - 4 - 8);
}

void check(const osg::Object* object)
{
    if (const auto* geometry = dynamic_cast<const VolumeGeometry*>(object))
        if (!geometry->getTetraSet()->validate().ok()) std::abort();
    if (const auto* table = dynamic_cast<const LookupTable*>(object))
        if (table->getFunction()->points().empty()) std::abort();
    if (const auto* source = dynamic_cast<const MemoryVoxelSource*>(object))
        if (source->data() && !source->describe().validate().ok()) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    if (size == 0 || !readerWriter()) return 0;
    // In a binary file OSG itself would read what follows an appearance's record.
    const bool binary = data[0] & 4;
    const int which = binary && (data[0] & 3) == 2 ? 0 : data[0] & 3;
    static const std::string prefixes[2][4] = {
        {prefix(0, false), prefix(1, false), prefix(2, false), prefix(3, false)},
        {prefix(0, true), prefix(1, true), prefix(0, true), prefix(3, true)}};
    const std::string record(reinterpret_cast<const char*>(data) + 1, size - 1);
    // No other files, and no other objects: those are OSG's own to read.
    if (record.find("File") != std::string::npos || record.find("::") != std::string::npos)
        return 0;

    std::stringstream file(prefixes[binary][which] + record + (binary ? "" : "\n}\n}\n"));
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    if (!binary) options->setPluginStringData("fileType", "Ascii");
    osgDB::ReaderWriter::ReadResult result = readerWriter()->readObject(file, options.get());
    check(result.getObject());
    return 0;
}
