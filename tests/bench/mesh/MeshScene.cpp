#include "MeshScene.h"

#include <oracles/TestMeshes.h>

#include <cmath>

namespace osgVolumizer {
namespace bench {

namespace {

/// The test signal of Marschner and Lobb over the unit cube, with waves that the coarsest mesh
/// shows.
class WaveField : public oracle::Field
{
public:
    double value(const glm::dvec3& p) const override { return _signal.value(2.0 * p - 1.0); }
    glm::dvec3 gradient(const glm::dvec3& p) const override
    {
        return 2.0 * _signal.gradient(2.0 * p - 1.0);
    }

private:
    oracle::MarschnerLobbField _signal{2.0};
};

} // namespace

support::RenderOptions MeshScene::view(int number) const
{
    const double angle = 0.5 + number * osg::DegreesToRadians(1.0);
    const osg::Vec3d center(0.5, 0.5, 0.5);
    const osg::Vec3d toEye(0.87 * std::cos(angle), 0.87 * std::sin(angle), 0.5);
    support::RenderOptions options;
    options.size(512, 512);
    if (orthographic)
        options.orthographic(0.87);
    else
        options.perspective(40.0);
    options.lookAt(center + toEye * 2.6, center, {0.0, 0.0, 1.0});
    return options;
}

std::vector<std::string> meshSceneNames()
{
    return {"smooth", "smooth-ortho", "peak"};
}

MeshScene makeMeshScene(const std::string& name, int n)
{
    MeshScene scene;
    scene.name = name;
    scene.unit = 0.05;
    scene.orthographic = name == "smooth-ortho";
    scene.table = name == "peak" ? peakTable() : smoothTable(0.12);
    if (name == "smooth")
        scene.description = "smooth table";
    else if (name == "smooth-ortho")
        scene.description = "smooth table, orthographic";
    else if (name == "peak")
        scene.description = "sharp peak in the table";
    else
        return scene;
    scene.mesh = oracle::latticeMesh(glm::ivec3(n), oracle::HexahedronSplit::FIVE);
    oracle::jitter(scene.mesh, 0.25 / n, 1);
    oracle::sampleField(scene.mesh, WaveField());
    return scene;
}

} // namespace bench
} // namespace osgVolumizer
