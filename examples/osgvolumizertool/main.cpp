// osgvolumizertool: tells what is in volume files, and makes some: 3D TIFF, a page a slice, which
// OpenImageIO, ImageJ and `osgviewer file.tif.volume` read, or whatever writeVoxels() writes.

#include "Cubes.h"
#include "Info.h"
#include "ProgressLine.h"

#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/Version.h>
#include <osgVolumizer/WritePyramid.h>
#include <osgVolumizer/WriteVoxels.h>
#include <osgVolumizer/core/Text.h>

#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

using namespace osgVolumizer;

namespace {

const char* const help =
    R"(osgvolumizertool: tells what is in volume files, and makes some

  osgvolumizertool info VOLUME
      Size, type, spacing, where it lies, range of values, histogram, time steps, memory.

  osgvolumizertool list VOLUME
      The volumes in a file or folder (series of DICOM, datasets, grids): what option dataset= takes, and
      what they are. The one that is read is marked with *.

  osgvolumizertool convert VOLUME OUT
      Any volume to a 3D TIFF, or, where ITK was found, .nrrd, .nhdr, .nii, .nii.gz, .mha or .mhd, with its
      spacing and where it lies.

  osgvolumizertool mkcubes WIDTH HEIGHT DEPTH EDGE OUT.tif [--type TYPE]
      A test pattern: cubes of EDGE voxels, brightest in the middle. TYPE is int8, uint8 (the default),
      int16, uint16, int32, uint32, half, float32 or float64.

  osgvolumizertool raw2volume FILE.WIDTH,HEIGHT,DEPTH,TYPE[,HEADER[,big|little]] OUT.tif
      A raw file, x fastest, as in engine.raw.256,256,110,uint8. HEADER bytes at its start are skipped; the
      byte order is little unless said otherwise.

  osgvolumizertool stack2volume IN... OUT.tif
      2D images of one size, a slice each: a folder (in natural order), a numbered pattern ("s%03d.png",
      "s###.png"), or the files one by one.

  osgvolumizertool pyramid IN OUT.tif [--levels mean|mode]
      A volume and coarser copies of it, for volumes that are larger than memory: viewers read of it what they
      show. IN is any volume (a raw file as above). Samples of a coarser level are means, or the most frequent
      value, for labels. What was interrupted is gone on with by the same command.

Options: -O "OPTION=VALUE ..." (of the loader, as for osgviewer: -O "dataset=2 channel=1"), --quiet (no
progress), --help, --version.
Exit status: 0 done, 1 a file cannot be read or written, 2 the command line is wrong.
)";

/// What holds for all commands.
struct Flags
{
    bool quiet = false;
    osg::ref_ptr<osgDB::Options> loader = new osgDB::Options;
};

constexpr int DONE = 0, FAILED = 1, USAGE = 2;

int fail(int code, const std::string& message)
{
    std::cerr << "osgvolumizertool: " << message << '\n';
    if (code == USAGE) std::cerr << "See osgvolumizertool --help.\n";
    return code;
}

// Of voxels, or of a source of them.
template <class Source>
int write(const Source& voxels, const VoxelSource::Description& d, const std::string& fileName,
          const Flags& flags)
{
    Status status;
    {
        ProgressLine line("writing " + fileName, flags.quiet);
        status = writeVoxels(voxels, fileName, std::ref(line));
    }
    if (!status.ok()) return fail(FAILED, status.text);
    std::cout << fileName << ": " << core::formatTriple(d.size) << " voxels of "
              << (d.components == 4 ? "4 x " : "") << voxelTypeName(d.type) << '\n';
    return DONE;
}

Result<osg::ref_ptr<Voxels>> read(const std::string& in, const Flags& flags)
{
    ProgressLine line("reading " + in, flags.quiet);
    return readVoxels(in, flags.loader, std::ref(line));
}

int info(const std::vector<std::string>& arguments, const Flags& flags)
{
    if (arguments.size() != 1) return fail(USAGE, "info takes one VOLUME");
    const Result<osg::ref_ptr<Voxels>> voxels = read(arguments[0], flags);
    if (!voxels.ok()) return fail(FAILED, voxels.status.text);
    const Result<std::vector<VolumeEntry>> entries = listVolumes(arguments[0], flags.loader);
    for (const VolumeEntry& entry : entries.ok() ? *entries : std::vector<VolumeEntry>())
        if (entry.chosen && !(entry.name + entry.text).empty())
            std::cout << "volume       " << entry.name << (entry.name.empty() ? "" : "  ")
                      << entry.text << '\n';
    const Status status = printInfo(std::cout, **voxels);
    return status.ok() ? DONE : fail(FAILED, status.text);
}

int list(const std::vector<std::string>& arguments, const Flags& flags)
{
    if (arguments.size() != 1) return fail(USAGE, "list takes one VOLUME");
    const Result<std::vector<VolumeEntry>> entries = listVolumes(arguments[0], flags.loader);
    if (!entries.ok()) return fail(FAILED, entries.status.text);
    printList(std::cout, *entries);
    return DONE;
}

int convert(const std::string& in, const std::string& out, const Flags& flags)
{
    const Result<osg::ref_ptr<Voxels>> voxels = read(in, flags);
    if (!voxels.ok()) return fail(FAILED, voxels.status.text);
    if ((*voxels)->getStepCount() > 1)
        std::cerr << in << " has " << (*voxels)->getStepCount()
                  << " time steps, of which the first is written\n";
    return write(**voxels, (*voxels)->getSource()->describe(), out, flags);
}

// A file that is written over is not gone on with.
std::string originOf(const std::string& in)
{
    std::error_code unknown;
    const std::string file = in.substr(0, in.find(','));
    for (const std::string& name : {in, file.substr(0, file.rfind('.'))}) {
        const auto bytes = std::filesystem::file_size(name, unknown);
        if (unknown) continue;
        const auto time = std::filesystem::last_write_time(name, unknown).time_since_epoch();
        return in + ", " + std::to_string(bytes) + " bytes of " + std::to_string(time.count());
    }
    return in;
}

int makePyramid(const std::vector<std::string>& arguments, const std::string& rule,
                const Flags& flags)
{
    if (arguments.size() != 2) return fail(USAGE, "pyramid takes IN and OUT.tif");
    if (rule != "mean" && rule != "mode")
        return fail(USAGE, "option \"--levels\" is \"" + rule + "\", neither mean nor mode");
    const std::string &in = arguments[0], &out = arguments[1];
    const Result<osg::ref_ptr<Voxels>> voxels = read(in, flags);
    if (!voxels.ok()) return fail(FAILED, voxels.status.text);
    PyramidOptions options;
    options.rule = rule == "mode" ? core::LevelRule::MODE : core::LevelRule::MEAN;
    options.origin = originOf(in) + ", " + flags.loader->getOptionString();
    Status status;
    {
        ProgressLine line("writing " + out, flags.quiet);
        status = writePyramid(**voxels, out, options, std::ref(line));
    }
    if (!status.ok()) return fail(FAILED, status.text);
    std::cout << out << ": " << core::formatTriple((*voxels)->getSource()->describe().size)
              << " voxels in levels\n";
    return DONE;
}

int makeCubes(const std::vector<std::string>& arguments, VoxelType type, const Flags& flags)
{
    if (arguments.size() != 5)
        return fail(USAGE, "mkcubes takes WIDTH HEIGHT DEPTH EDGE OUT.tif, not " +
                               std::to_string(arguments.size()) + " arguments");
    static const char* const names[] = {"WIDTH", "HEIGHT", "DEPTH", "EDGE"};
    std::int64_t numbers[4];
    for (std::size_t i = 0; i < 4; ++i)
        if (!core::parseInteger(arguments[i], numbers[i]) || numbers[i] < 1 || numbers[i] > 65536)
            return fail(USAGE, "mkcubes: " + std::string(names[i]) + " is \"" + arguments[i] +
                                   "\", not a number of voxels from 1 to 65536");
    const glm::ivec3 size(static_cast<int>(numbers[0]), static_cast<int>(numbers[1]),
                          static_cast<int>(numbers[2]));
    osg::ref_ptr<Cubes> cubes = new Cubes(size, static_cast<int>(numbers[3]), type);
    return write(*cubes, cubes->describe(), arguments[4], flags);
}

int stackToVolume(std::vector<std::string> arguments, const Flags& flags)
{
    if (arguments.size() < 2) return fail(USAGE, "stack2volume takes IN... OUT.tif");
    const std::string out = arguments.back();
    arguments.pop_back();
    if (arguments.size() == 1) return convert(arguments[0], out, flags);
    Result<osg::ref_ptr<Voxels>> voxels(Status{});
    {
        ProgressLine line("reading " + std::to_string(arguments.size()) + " slices", flags.quiet);
        voxels = readSlices(arguments, flags.loader, std::ref(line));
    }
    if (!voxels.ok()) return fail(FAILED, voxels.status.text);
    return write(**voxels, (*voxels)->getSource()->describe(), out, flags);
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::string> arguments(argv + 1, argv + argc);
    Flags flags;
    std::string typeName = "uint8";
    bool typeGiven = false;
    std::string levels = "mean";
    bool levelsGiven = false;
    for (std::size_t i = 0; i < arguments.size();) {
        const std::string option = arguments[i];
        if (option == "-O" && i + 1 < arguments.size()) {
            flags.loader->setOptionString(flags.loader->getOptionString() + " " + arguments[i + 1]);
            arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i),
                            arguments.begin() + static_cast<std::ptrdiff_t>(i) + 2);
            continue;
        }
        if (option.compare(0, 2, "--") != 0) {
            ++i;
            continue;
        }
        arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
        if (option == "--help") {
            std::cout << help << "\nOptions of the loader:\n";
            for (const VolumeOption& row : volumeOptions())
                std::cout << "  " << row.name << '=' << row.values << "\n      " << row.help
                          << '\n';
            return DONE;
        } else if (option == "--version") {
            std::cout << "osgvolumizertool " << getVersion() << '\n';
            return DONE;
        } else if (option == "--quiet") {
            flags.quiet = true;
        } else if (option == "--type" && i < arguments.size()) {
            typeName = arguments[i];
            typeGiven = true;
            arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
        } else if (option == "--levels" && i < arguments.size()) {
            levels = arguments[i];
            levelsGiven = true;
            arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            return fail(USAGE, "option \"" + option + "\" is unknown, or lacks its value");
        }
    }
    if (arguments.empty()) return fail(USAGE, "no command");
    const std::string command = arguments.front();
    arguments.erase(arguments.begin());
    if (typeGiven && command != "mkcubes")
        return fail(USAGE, "option \"--type\" is for mkcubes only");
    if (levelsGiven && command != "pyramid")
        return fail(USAGE, "option \"--levels\" is for pyramid only");
    const Result<VoxelType> type = voxelTypeFromName(typeName);
    if (!type.ok()) return fail(USAGE, type.status.text);
    if (command == "info") return info(arguments, flags);
    if (command == "list") return list(arguments, flags);
    if (command == "convert") {
        if (arguments.size() != 2) return fail(USAGE, "convert takes VOLUME and OUT");
        return convert(arguments[0], arguments[1], flags);
    }
    if (command == "pyramid") return makePyramid(arguments, levels, flags);
    if (command == "mkcubes") return makeCubes(arguments, *type, flags);
    if (command == "raw2volume") {
        if (arguments.size() != 2)
            return fail(USAGE, "raw2volume takes FILE.WIDTH,HEIGHT,DEPTH,TYPE and OUT.tif");
        if (arguments[0].find(',') == std::string::npos)
            return fail(USAGE, "raw2volume: \"" + arguments[0] +
                                   "\" does not end in .WIDTH,HEIGHT,DEPTH,TYPE");
        return convert(arguments[0], arguments[1], flags);
    }
    if (command == "stack2volume") return stackToVolume(arguments, flags);
    return fail(USAGE, "command \"" + command +
                           "\" is none of info, list, convert, "
                           "mkcubes, raw2volume, stack2volume, pyramid");
}
