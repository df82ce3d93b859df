#pragma once

#include <osgVolumizer/AppearanceProperties.h>

#include <osg/Vec3d>
#include <osg/Vec4>

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What the command line asks for.
struct Arguments
{
    std::string scene;
    std::string readerOptions; ///< for osgDB's readers, e.g. those of .volume
    int width = 512;
    int height = 512;
    std::optional<osg::Vec3d> eye, center, up;
    std::optional<double> fovyDegrees, orthographicHalfHeight;
    osg::Vec4 background{0.0f, 0.0f, 0.0f, 0.0f}; ///< premultiplied
    /// What every appearance of the scene gets.
    std::vector<std::pair<const osgVolumizer::AppearanceProperty*,
                          osgVolumizer::AppearanceProperty::Values>>
        properties;
    std::string output;
    std::string stats;
    std::optional<std::string> device; ///< the number of EGL's, as it was typed
    bool listDevices = false;
    int frames = 1;
    double turnDegrees = 0.0;  ///< from frame to frame
    double time = 0.0;         ///< simulation time, seconds
    double waitSeconds = 60.0; ///< for volumes that are read in the background
    bool help = false;
    bool version = false;
};

/// Refuses unknown options, missing or surplus values, and values that make no sense, naming both.
osgVolumizer::Result<Arguments> parseArguments(int argc, const char* const* argv);
/// The text of --help.
std::string usage();
