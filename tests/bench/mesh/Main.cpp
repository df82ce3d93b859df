// Time and error of renderers of unstructured grids: see ../mesh_chart.sh.

#include "../support/CommandLine.h"
#include "../support/Median.h"
#include "MeshMeasure.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>

using namespace osgVolumizer;
using namespace osgVolumizer::bench;

namespace {

const char* const usage = R"(Usage: osgVolumizerMeshChart [options]
  --scenes A,B,..     of smooth smooth-ortho peak; default all
  --renderers A,B,..  of library projected preintegrated partial linear (all but the first are
                      VTK's); default library,projected,preintegrated,partial
  --sizes A,B,..      hexahedra along each axis, of five tetrahedra each; default 13,27,40,58. A
                      renderer whose frames take more than --patience is not measured at larger ones
  --patience SECONDS  default 10
  --rounds N          default 5
  --csv FILE          writes the points
  --pictures          writes PNG and EXR of every renderer at every size to build/pictures
)";

struct Arguments
{
    std::vector<std::string> scenes = meshSceneNames();
    std::vector<std::string> renderers{"library", "projected", "preintegrated", "partial"};
    std::vector<std::string> sizes{"13", "27", "40", "58"};
    double patience = 10.0;
    int rounds = 5;
    std::string csv;
    bool pictures = false;
};

bool parse(int argc, char** argv, Arguments& a)
{
    for (int i = 1; i < argc; ++i) {
        const std::string key = argv[i];
        if (key == "--pictures") {
            a.pictures = true;
            continue;
        }
        if (i + 1 == argc) return false;
        const std::string value = argv[++i];
        if (key == "--scenes")
            a.scenes = splitList(value);
        else if (key == "--renderers")
            a.renderers = splitList(value);
        else if (key == "--sizes")
            a.sizes = splitList(value);
        else if (key == "--patience")
            a.patience = std::atof(value.c_str());
        else if (key == "--rounds")
            a.rounds = std::atoi(value.c_str());
        else if (key == "--csv")
            a.csv = value;
        else
            return false;
    }
    return a.rounds > 0;
}

void report(const MeshPoint& p, const MeshScene& scene, const Arguments& a, std::ostream& csv)
{
    const double wall = median(p.milliseconds), cpu = median(p.cpuMilliseconds);
    std::printf("  %-26s %9.2f ms %9.2f cpu  rmse %.2e max %.2e bias %+.2e\n", p.renderer.c_str(),
                wall, cpu, p.difference.rmse, p.difference.maximum, p.difference.bias);
    csv << scene.name << ",\"" << scene.description << "\"," << p.renderer << ','
        << scene.mesh.cells.size() << ',' << p.difference.pixels << ',' << p.difference.rmse << ','
        << p.difference.maximum << ',' << p.difference.bias << ',' << wall << ',' << cpu << ','
        << joinValues(p.milliseconds) << ',' << joinValues(p.cpuMilliseconds) << std::endl;
    if (a.pictures)
        support::savePicture(p.picture, "mesh " + scene.name + " " +
                                            std::to_string(scene.mesh.cells.size()) + " " +
                                            p.renderer);
}

// Those still in time.
std::vector<MeshRendererPtr> makeRenderers(const Arguments& a, const std::set<std::string>& tooSlow)
{
    std::vector<MeshRendererPtr> renderers;
    for (const std::string& name : a.renderers) {
        MeshRendererPtr renderer = makeMeshRenderer(name);
        if (!renderer)
            std::cerr << "No renderer '" << name << "' was built.\n";
        else if (tooSlow.count(renderer->name()) == 0)
            renderers.push_back(std::move(renderer));
    }
    return renderers;
}

bool chart(const Arguments& a, const std::string& name, std::ostream& csv)
{
    std::set<std::string> tooSlow;
    for (const std::string& size : a.sizes) {
        const MeshScene scene = makeMeshScene(name, std::atoi(size.c_str()));
        if (scene.mesh.cells.empty()) return false;
        const support::FloatImage reference = meshReference(scene);
        std::printf("%s: %s, %zu tetrahedra, %zu pixels\n", name.c_str(), scene.description.c_str(),
                    scene.mesh.cells.size(), support::coveredPixels(reference).count());
        const auto renderers = makeRenderers(a, tooSlow);
        for (const MeshPoint& point : measureMesh(scene, reference, renderers, a.rounds)) {
            report(point, scene, a, csv);
            if (median(point.milliseconds) > 1e3 * a.patience) tooSlow.insert(point.renderer);
        }
        std::fflush(stdout);
    }
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    Arguments a;
    if (!parse(argc, argv, a)) {
        std::cerr << usage;
        return 2;
    }
    std::ofstream csv;
    if (!a.csv.empty()) csv.open(a.csv);
    csv << "scene,description,renderer,tetrahedra,pixels,rmse,maximum,bias,wall_ms,cpu_ms,"
           "wall_ms_rounds,cpu_ms_rounds\n";
    for (const std::string& name : a.scenes)
        if (!chart(a, name, csv)) {
            std::cerr << "No scene '" << name << "', or a size below 1.\n";
            return 1;
        }
    return 0;
}
