// Volume files of VTK under their own names: what readVolume() makes of them, as in:
// osgviewer -O "dataset=pressure table=heat.lut" flow.vti

#include <osgVolumizer/ReadVolume.h>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#define OSGVOLUMIZER_TEXT_OF(name) #name
#define OSGVOLUMIZER_TEXT(name) OSGVOLUMIZER_TEXT_OF(name)
#define OSGVOLUMIZER_REGISTER(name, reader) REGISTER_OSGPLUGIN(name, reader)

namespace {

class ReaderVolumeFile : public osgDB::ReaderWriter
{
public:
    ReaderVolumeFile()
    {
        supportsExtension(OSGVOLUMIZER_TEXT(OSGVOLUMIZER_EXTENSION),
                          "Volume of VTK (osgVolumizer)");
        for (const osgVolumizer::VolumeOption& option : osgVolumizer::volumeOptions())
            supportsOption(option.name + "=" + option.values, option.help);
    }
    const char* className() const override { return "osgVolumizer reader of VTK's volumes"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        return readNode(name, options);
    }
    ReadResult readNode(const std::string& name, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
            return ReadResult::FILE_NOT_HANDLED;
        if (osgDB::findDataFile(name, options).empty()) return ReadResult::FILE_NOT_FOUND;
        const auto appearance = osgVolumizer::readVolume(name, options);
        if (appearance.ok()) return appearance->get();
        return ReadResult(appearance.status.text); // that is, ERROR_IN_READING_FILE
    }
};

} // namespace

OSGVOLUMIZER_REGISTER(OSGVOLUMIZER_EXTENSION, ReaderVolumeFile)
