#include "Measure.h"
#ifdef OSGVOLUMIZER_CHART_VTK
#include "VtkRenderer.h"
#endif

#include <osg/Notify>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

using namespace osgVolumizer;
using namespace osgVolumizer::bench;

namespace {

std::vector<std::string> split(const std::string& text, char separator = ',')
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

struct Arguments
{
    std::vector<std::string> scenes, renderers;
    MeasureOptions measure;
    std::string csv;
};

std::vector<RendererPtr> makeRenderers(const std::vector<std::string>& names)
{
    std::vector<RendererPtr> result;
    for (const std::string& name : names) {
        if (name == "slabs" || name == "slices")
            result.push_back(makeLibraryRenderer(name == "slabs"));
        else if (name == "fixed")
            result.push_back(makeOsgVolumeRenderer(OsgVolumeTechnique::FIXED_FUNCTION));
        else if (name == "raytraced")
            result.push_back(makeOsgVolumeRenderer(OsgVolumeTechnique::RAY_TRACED));
        else if (name == "multipass")
            result.push_back(makeOsgVolumeRenderer(OsgVolumeTechnique::MULTIPASS));
#ifdef OSGVOLUMIZER_CHART_VTK
        else if (name == "vtkgpu" || name == "vtkcpu")
            result.push_back(makeVtkRenderer(name == "vtkgpu"));
#endif
        else if (name.compare(0, 4, "bare") == 0)
            result.push_back(makeBareRenderer(name.size() > 5 ? name.substr(5) : ""));
    }
    return result;
}

} // namespace

int main(int argc, char** argv)
{
    osg::setNotifyLevel(osg::WARN);
    Arguments a;
    a.renderers = {"slabs", "slices", "bare"};
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string key = argv[i], value = argv[i + 1];
        if (key == "--scenes") a.scenes = split(value);
        if (key == "--renderers") a.renderers = split(value);
        if (key == "--rounds") a.measure.rounds = std::atoi(value.c_str());
        if (key == "--csv") a.csv = value;
        if (key == "--pictures") a.measure.pictures = value == "1";
        if (key == "--steps") {
            a.measure.steps.clear();
            for (const auto& s : split(value)) a.measure.steps.push_back(std::atof(s.c_str()));
        }
    }
    for (const ChartScene& scene : chartScenes(a.scenes)) {
        const Reference r = reference(scene);
        std::printf("%s: %s, %zu pixels, reference good to %.1e\n", scene.name.c_str(),
                    scene.description.c_str(), r.mask.count(), r.remainingError);
        const std::vector<RendererPtr> renderers = makeRenderers(a.renderers);
        for (const Point& p : measure(scene, r, renderers, a.measure))
            std::printf("%-44s %6.3f  %8.2f ms %8.2f cpu  rmse %.2e max %.2e bias %+.2e\n",
                        p.renderer.c_str(), p.step, median(p.milliseconds),
                        median(p.cpuMilliseconds), p.difference.rmse, p.difference.maximum,
                        p.difference.bias);
    }
    return 0;
}
