// Translucent geometry in and around volumes, against the oracle.

#include "Volumes.h"

#include <oracles/Grid.h>
#include <oracles/Scene.h>
#include <support/GLTest.h>
#include <support/Shapes.h>

#include <cmath>

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using Merge = support::GLTest;

const std::vector<core::TransferFunction::Point> TABLE = {{0.0, {0.1, 0.3, 0.9, 0.02}},
                                                          {1.0, {1.0, 0.4, 0.1, 0.2}}};

double blob(const glm::dvec3& p) { return std::exp(-glm::dot(p - 16.0, p - 16.0) / 60.0); }

TEST_F(Merge, SlantedQuad)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), blob);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(TABLE));
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(volume);
    const std::array<osg::Vec3, 4> corners = {osg::Vec3(-5, -3, 2), osg::Vec3(37, 0, 6),
                                              osg::Vec3(40, 36, 30), osg::Vec3(-4, 30, 25)};
    scene->addChild(support::makeQuad(corners, {0.1f, 0.9f, 0.2f, 0.6f}, true));

    RenderOptions options;
    options.size(256, 256).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    support::SceneRenderer renderer(scene, options);
    const FloatImage picture = renderer.render();
    for (const auto& c : renderer.counters()) std::cout << c.first << " " << c.second << "\n";
    support::savePicture(picture, "merge_quad");

    oracle::Scene truth;
    const auto grid = std::make_shared<oracle::Grid>(
        glm::ivec3(33),
        [&] {
            std::vector<double> v;
            for (int z = 0; z < 33; ++z)
                for (int y = 0; y < 33; ++y)
                    for (int x = 0; x < 33; ++x) v.push_back(float(blob(glm::dvec3(x, y, z))));
            return v;
        }());
    truth.volumes.push_back(oracle::voxelVolume(grid, glm::ivec3(33), oracle::Table(TABLE)));
    std::array<glm::dvec3, 4> c;
    for (int i = 0; i < 4; ++i) c[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
    truth.addQuad(c, {0.1f, 0.9f, 0.2f, 0.6f});
    oracle::Camera camera;
    const osg::Matrixd &v = options.view, &p = options.projection;
    for (int i = 0; i < 16; ++i) camera.view[i / 4][i % 4] = v.ptr()[i], camera.projection[i / 4][i % 4] = p.ptr()[i];
    camera.width = camera.height = 256;
    const FloatImage expected = oracle::render(truth, camera);
    support::savePicture(expected, "merge_quad_oracle");
    const auto d = support::compare(picture, expected);
    std::cout << "rmse " << d.rmse << " max " << d.maximum << " at " << d.worstX << "," << d.worstY << " bias " << d.bias << "\n";
    const auto mask = support::coveredPixels(oracle::awayFromSilhouettes(truth, camera));
    const auto inner = support::compare(picture, expected, mask);
    std::cout << "inner rmse " << inner.rmse << " max " << inner.maximum << " at " << inner.worstX << "," << inner.worstY << "\n";
    FloatImage diff = picture; int n=0;
    for (size_t i = 0; i < diff.pixels.size(); ++i) { diff.pixels[i] = glm::vec4(20.0f*glm::abs(glm::vec3(picture.pixels[i]-expected.pixels[i])),1); if (mask.set[i] && glm::length(glm::vec3(diff.pixels[i]))>20*2e-3) ++n; }
    std::cout << "bad " << n << "\n";
    support::savePicture(diff, "merge_quad_diff");
    EXPECT_LT(d.rmse, 4e-3);
}

} // namespace
