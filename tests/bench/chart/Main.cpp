// Time against error of volume renderers: see ../chart.sh.

#include "../support/CommandLine.h"
#include "Measure.h"

#include <osg/Notify>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>

using namespace osgVolumizer;
using namespace osgVolumizer::bench;

namespace {

const char* const usage = R"(Usage: osgVolumizerChart [options]
  --scenes A,B,..     default all
  --renderers A,B,..  of slabs cells slices slabs:BRICK slices:BRICK apart:BRICK (bricks with a
                      texture each) tolerance bare bareintegral fixed raytraced multipass vtkgpu vtkcpu
                      volpack openvdb; default all that were built, bricks aside
  --steps A,B,..      sample distances in voxels, default 8,4,2,1,0.5,0.25,0.125; for
                      `tolerance`: the errors asked for, in thousandths. A renderer whose frames
                      take more than half a second is not measured at finer ones, nor any at
                      those that it does not have (volpack: others than 1, 0.5 and 0.25)
  --rounds N          default 5
  --csv FILE          writes the points
  --pictures          writes PNG and EXR of every renderer at the finest step to build/pictures
  --profile           draws --frames N frames of each renderer at the first step and prints where
                      the time goes; for callgrind: --toggle-collect='*drawFrames*'
  --frames N          default 20
)";

struct Arguments
{
    std::vector<std::string> scenes;
    std::vector<std::string> renderers{
        "slabs",     "tolerance", "cells",  "slices", "bare",    "bareintegral", "fixed",
        "raytraced", "multipass", "vtkgpu", "vtkcpu", "volpack", "openvdb"};
    MeasureOptions measure;
    std::string csv;
    bool profile = false;
    int frames = 20;
};

bool parse(int argc, char** argv, Arguments& a)
{
    for (int i = 1; i < argc; ++i) {
        const std::string key = argv[i];
        if (key == "--pictures") {
            a.measure.pictures = true;
            continue;
        }
        if (key == "--profile") {
            a.profile = true;
            continue;
        }
        if (i + 1 == argc) return false;
        const std::string value = argv[++i];
        if (key == "--scenes")
            a.scenes = splitList(value);
        else if (key == "--renderers")
            a.renderers = splitList(value);
        else if (key == "--rounds")
            a.measure.rounds = std::atoi(value.c_str());
        else if (key == "--frames")
            a.frames = std::atoi(value.c_str());
        else if (key == "--csv")
            a.csv = value;
        else if (key == "--steps") {
            a.measure.steps.clear();
            for (const auto& s : splitList(value))
                a.measure.steps.push_back(std::atof(s.c_str()));
        } else
            return false;
    }
    return !a.measure.steps.empty() && a.measure.rounds > 0 && a.frames > 0;
}

std::vector<RendererPtr> makeRenderers(const std::vector<std::string>& names)
{
    std::vector<RendererPtr> result;
    for (const std::string& name : names) {
        RendererPtr renderer = makeRenderer(name);
        if (renderer)
            result.push_back(std::move(renderer));
        else
            std::cerr << "No renderer '" << name << "' was built.\n";
    }
    return result;
}

void printPoint(const Point& p)
{
    std::printf("  %-28s step %5.3f %9.2f ms %9.2f cpu  rmse %.2e max %.2e bias %+.2e\n",
                p.renderer.c_str(), p.step, median(p.milliseconds), median(p.cpuMilliseconds),
                p.difference.rmse, p.difference.maximum, p.difference.bias);
}

void writePoint(std::ostream& csv, const Point& p, const ChartScene& scene, const Reference& r)
{
    csv << p.scene << ",\"" << scene.description << "\",\"" << p.renderer << "\"," << p.step << ','
        << p.difference.pixels << ',' << r.remainingError << ',' << p.difference.rmse << ','
        << p.difference.maximum << ',' << p.difference.bias << ',' << median(p.milliseconds) << ','
        << median(p.cpuMilliseconds) << ',' << joinValues(p.milliseconds) << ','
        << joinValues(p.cpuMilliseconds) << std::endl;
}

void chart(const Arguments& a, const std::vector<ChartScene>& scenes)
{
    std::ofstream csv;
    if (!a.csv.empty()) csv.open(a.csv);
    csv << "scene,description,renderer,step_voxel,pixels,reference_error,rmse,maximum,bias,"
           "wall_ms,cpu_ms,wall_ms_rounds,cpu_ms_rounds\n";
    for (const ChartScene& scene : scenes) {
        const Reference r = reference(scene);
        std::printf("%s: %s, %zu pixels, reference good to %.1e\n", scene.name.c_str(),
                    scene.description.c_str(), r.mask.count(), r.remainingError);
        const std::vector<RendererPtr> renderers = makeRenderers(a.renderers);
        for (const Point& p : measure(scene, r, renderers, a.measure)) {
            printPoint(p);
            writePoint(csv, p, scene, r);
        }
        std::fflush(stdout);
    }
}

void profile(const Arguments& a, const std::vector<ChartScene>& scenes)
{
    for (const ChartScene& scene : scenes)
        for (const RendererPtr& renderer : makeRenderers(a.renderers)) {
            Status status = renderer->open(scene);
            if (status.ok()) status = renderer->setStep(a.measure.steps.front());
            std::printf("%s, %s, step %g: %s\n", scene.name.c_str(), renderer->name().c_str(),
                        a.measure.steps.front(), status.text.c_str());
            if (!status.ok()) continue;
            drawFrames(*renderer, 2);
            std::printf("  frame, ms: %.3f (median of %d)\n",
                        median(drawFrames(*renderer, a.frames)), a.frames);
            for (const auto& part : renderer->split())
                std::printf("  %s: %.3f\n", part.first.c_str(), part.second);
        }
}

} // namespace

int main(int argc, char** argv)
{
    osg::setNotifyLevel(osg::FATAL); // osgVolume warns of shader files that it does not need
    Arguments a;
    if (!parse(argc, argv, a)) {
        std::cerr << usage;
        return 2;
    }
    const std::vector<ChartScene> scenes = chartScenes(a.scenes);
    if (scenes.empty()) {
        std::cerr << "No such scene.\n";
        return 1;
    }
    if (a.profile)
        profile(a, scenes);
    else
        chart(a, scenes);
    return 0;
}
