#pragma once

#include "Arguments.h"

#include <support/SurfacelessGraphicsContext.h>

#include <map>
#include <string>
#include <vector>

/// What --stats writes.
struct Statistics
{
    std::vector<double> milliseconds;          ///< of each timed frame
    std::map<std::string, double> firstFrame;  ///< counters of the frame that was not timed
    std::map<std::string, double> latestFrame; ///< counters of the last frame
    osgVolumizer::support::DrawingDevice device;
};

osgVolumizer::Status writeStatistics(const Statistics& statistics, const Arguments& arguments);
