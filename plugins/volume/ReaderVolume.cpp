// The .volume pseudo-loader: whatever readVolume() reads, with ".volume" behind its name.
// "head.tif.volume", "folder.volume", "slice%03d.png.volume",
// "engine.raw.256,256,110,uint8.volume"; everything else through the option string, as in:
// osgviewer -O "spacing=1,1,1.5 table=bone.lut" head.tif.volume

#include <osgVolumizer/ReadVolume.h>

#include <osgDB/FileNameUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

namespace {

class ReaderVolume : public osgDB::ReaderWriter
{
public:
    ReaderVolume()
    {
        supportsExtension("volume", "Pseudo-loader for volumes (osgVolumizer)");
        for (const osgVolumizer::VolumeOption& option : osgVolumizer::volumeOptions())
            supportsOption(option.name + "=" + option.values, option.help);
    }
    const char* className() const override { return "osgVolumizer volume pseudo-loader"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        return readNode(name, options);
    }
    ReadResult readNode(const std::string& name, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string volume = osgDB::getNameLessExtension(name);
        if (volume.empty()) return ReadResult::FILE_NOT_HANDLED;
        const auto appearance = osgVolumizer::readVolume(volume, options);
        if (appearance.ok()) return appearance->get();
        // That is, ERROR_IN_READING_FILE, which osgDB, or whoever called it, tells its user.
        return ReadResult(appearance.status.text);
    }
};

} // namespace

REGISTER_OSGPLUGIN(volume, ReaderVolume)
