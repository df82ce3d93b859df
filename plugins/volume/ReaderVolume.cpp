// The .volume pseudo-loader: whatever readVolume() reads, with ".volume" behind its name.
// "head.tif.volume", "folder.volume", "slice%03d.png.volume",
// "engine.raw.256,256,110,uint8.volume"; everything else through the option string, as in:
// osgviewer -O "spacing=1,1,1.5 table=bone.lut" head.tif.volume

#include <osgVolumizer/Error.h>
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
        supportsOption("spacing=x,y,z", "Object units between samples; 1,1,1");
        supportsOption("origin=x,y,z", "Object position of the first sample; 0,0,0");
        supportsOption("range=low,high", "Data values at the ends of the lookup table's domain");
        supportsOption("brick=n", "Samples per axis of a brick; 256");
        supportsOption("unit=x", "Object units that the table's opacity is stated for");
        supportsOption("table=file", "Lookup table, .lut or .tf");
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
        osgVolumizer::reportError(appearance.status);
        return ReadResult(appearance.status.text); // that is, ERROR_IN_READING_FILE
    }
};

} // namespace

REGISTER_OSGPLUGIN(volume, ReaderVolume)
