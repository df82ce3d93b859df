#include "Arguments.h"

#include <osgVolumizer/ReadVolume.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>

using osgVolumizer::ErrorCode;
using osgVolumizer::Result;
using osgVolumizer::Status;

namespace {

Status invalid(const std::string& text)
{
    return Status(ErrorCode::VALUE_INVALID, text);
}

/// The words after an option, taken one by one.
struct Words
{
    int argc;
    const char* const* argv;
    int next;
    std::string option;
    Status status;

    std::string text()
    {
        if (!status.ok()) return {};
        if (next < argc) return argv[next++];
        status = invalid("Option " + option + " lacks a value.");
        return {};
    }
    double number(double low, double high)
    {
        const std::string word = text();
        if (!status.ok()) return 0.0;
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (word.empty() || *end || !std::isfinite(value) || value < low || value > high)
            status = invalid("Option " + option + " cannot take the value '" + word + "'.");
        return value;
    }
    int integer(int low, int high)
    {
        const double value = number(low, high);
        if (status.ok() && value != std::floor(value))
            status = invalid("Option " + option + " takes whole numbers only.");
        return status.ok() ? int(value) : 0;
    }
    osg::Vec3d vector()
    {
        osg::Vec3d v;
        for (int i = 0; i < 3; ++i)
            v[i] = number(-1e30, 1e30);
        return v;
    }
    osg::Vec4 color()
    {
        osg::Vec4 c;
        for (int i = 0; i < 4; ++i)
            c[i] = float(number(-1e30, 1e30));
        return c;
    }
};

/// A property of appearances, by the name of its option.
bool takeProperty(Arguments& arguments, Words& words)
{
    if (words.option.compare(0, 2, "--") != 0) return false;
    const osgVolumizer::AppearanceProperty* property =
        osgVolumizer::findAppearanceOption(words.option.substr(2));
    if (!property) return false;
    const std::string text = words.text();
    if (!words.status.ok()) return true;
    const auto values = osgVolumizer::parseAppearanceValues(*property, text);
    if (values.ok())
        arguments.properties.emplace_back(property, *values);
    else
        words.status = invalid("Option --" + values.status.text + ".");
    return true;
}

using Handler = std::function<void(Arguments&, Words&)>;

const std::map<std::string, Handler>& handlers()
{
    constexpr double tiny = 1e-300, huge = 1e30;
    static const std::map<std::string, Handler> table{
        {"--size",
         [](Arguments& a, Words& w) {
             a.width = w.integer(1, 16384);
             a.height = w.integer(1, 16384);
         }},
        {"--eye", [](Arguments& a, Words& w) { a.eye = w.vector(); }},
        {"--center", [](Arguments& a, Words& w) { a.center = w.vector(); }},
        {"--up", [](Arguments& a, Words& w) { a.up = w.vector(); }},
        {"--fovy", [](Arguments& a, Words& w) { a.fovyDegrees = w.number(1e-3, 179.0); }},
        {"--ortho",
         [](Arguments& a, Words& w) { a.orthographicHalfHeight = w.number(tiny, huge); }},
        {"--background", [](Arguments& a, Words& w) { a.background = w.color(); }},
        {"--output", [](Arguments& a, Words& w) { a.output = w.text(); }},
        {"--stats", [](Arguments& a, Words& w) { a.stats = w.text(); }},
        {"--device",
         [](Arguments& a, Words& w) {
             a.device = w.text();
             a.listDevices = a.device == "list";
         }},
        {"--frames", [](Arguments& a, Words& w) { a.frames = w.integer(1, 1000000); }},
        {"--turn", [](Arguments& a, Words& w) { a.turnDegrees = w.number(-360.0, 360.0); }},
        {"--time", [](Arguments& a, Words& w) { a.time = w.number(-1e9, 1e9); }},
        {"--wait-for-detail", [](Arguments& a, Words& w) { a.waitSeconds = w.number(0.0, 1e9); }},
        {"-O", [](Arguments& a, Words& w) { a.readerOptions = w.text(); }},
        {"--help", [](Arguments& a, Words&) { a.help = true; }},
        {"--version", [](Arguments& a, Words&) { a.version = true; }},
    };
    return table;
}

Status checkWhole(const Arguments& a)
{
    if (a.help || a.version || a.listDevices) return Status();
    if (a.scene.empty()) return invalid("No scene is named; see --help.");
    if (a.output.empty() && a.stats.empty())
        return invalid("Nothing is asked for: give --output, --stats, or both.");
    if (a.fovyDegrees && a.orthographicHalfHeight)
        return invalid("Options --fovy and --ortho exclude each other.");
    if (!a.eye && (a.center || a.up)) return invalid("Options --center and --up need --eye.");
    if (a.eye && a.center && *a.eye == *a.center)
        return invalid("Options --eye and --center name the same point.");
    return Status();
}

} // namespace

Result<Arguments> parseArguments(int argc, const char* const* argv)
{
    Arguments arguments;
    Words words{argc, argv, 1, {}, {}};
    while (words.next < argc) {
        words.option = argv[words.next++];
        const auto handler = handlers().find(words.option);
        if (handler != handlers().end())
            handler->second(arguments, words);
        else if (takeProperty(arguments, words))
            ;
        else if (words.option.size() > 1 && words.option[0] == '-')
            return invalid("There is no option '" + words.option + "'; see --help.");
        else if (!arguments.scene.empty())
            return invalid("Two scenes are named: '" + arguments.scene + "' and '" + words.option +
                           "'.");
        else
            arguments.scene = words.option;
        if (!words.status.ok()) return words.status;
    }
    const Status status = checkWhole(arguments);
    if (!status.ok()) return status;
    return arguments;
}

namespace {

// As much of a text as fits into the lines of --help.
void addRow(std::string& text, const std::string& option, const std::string& help)
{
    constexpr std::size_t COLUMN = 24, WIDTH = 100;
    std::string line = "  " + option;
    line.resize(std::max(line.size() + 1, COLUMN), ' ');
    std::istringstream words(help);
    std::string word;
    while (words >> word) {
        if (line.size() + word.size() >= WIDTH) {
            text += line + "\n";
            line.assign(COLUMN - 1, ' ');
        }
        line += (line.back() == ' ' && line.size() == COLUMN ? "" : " ") + word;
    }
    text += line + "\n";
}

} // namespace

std::string usage()
{
    std::string text = R"(osgvolumizerrender SCENE [options]
Renders a scene without a window and writes the picture, the statistics, or both.

  --output FILE         .exr (or .tif): 32-bit float RGBA, linear, premultiplied, rays through pixel
                        centres; .png: 8 bit, for people, with straight alpha. Over an opaque
                        background both have what osgviewer shows, else true coverage
  --stats FILE          JSON: milliseconds per frame (glFinish inside), the volumes' counters, and
                        which device drew
  --frames N            frames to time, after one that is not (1)
  --turn DEGREES        the viewer goes round the scene by so much from frame to frame, and is back
                        for the picture (0)
  --time SECONDS        simulation time, which plays volumes of several time steps (0)
  --wait-for-detail SECONDS
                        for how long to wait for volumes that are read in the background until the
                        picture is the final one (60)
  --size W H            pixels (512 512)
  --eye X Y Z           where the viewer is; without it, the whole scene is shown
  --center X Y Z        what is looked at (the scene's centre)
  --up X Y Z            what is upwards (0 0 1)
  --fovy DEGREES        vertical field of view (osgviewer's, 29.1)
  --ortho HALF_HEIGHT   parallel projection, half the picture's height in world units
  --background R G B A  premultiplied (0 0 0 0)
  --device N            EGL device that draws, by its number (OSGVOLUMIZER_EGL_DEVICE's; without it
                        Mesa's surfaceless platform, else the first device that opens)
  --device list         tells which there are
  -O STRING             options for the reader of SCENE, e.g. "spacing=1,1,1.5 table=bone.lut"
  --version             the library's version

What every volume of the scene gets instead of what it has:
)";
    for (const osgVolumizer::AppearanceProperty& property : osgVolumizer::appearanceProperties())
        addRow(text, std::string("--") + property.option,
               std::string(property.help) + " (" + osgVolumizer::appearanceValueText(property) +
                   ")");
    text += "\nIn the -O of a .volume (the above too, as name=value):\n";
    for (const osgVolumizer::VolumeOption& option : osgVolumizer::volumeOptions())
        if (!osgVolumizer::findAppearanceOption(option.name))
            addRow(text, option.name + "=" + option.values, option.help);
    return text + R"(
Lights and optimizer as in osgviewer. Exit code 0; 1 where the scene, or a part of it, cannot be
read, rendered or written, or the device is none; 2 for a wrong command line.
)";
}
