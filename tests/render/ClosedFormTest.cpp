// Pictures of volumes whose integrals are known, against the closed form.

#include "Volumes.h"

#include <support/GLTest.h>

#include <cmath>

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using ClosedForm = support::GLTest;

TEST_F(ClosedForm, FirstPicture)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), [](const glm::dvec3& p) {
        return std::exp(-glm::dot(p - 16.0, p - 16.0) / 80.0);
    });
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setTechnique(technique);
        volume->setLookupTable(makeTable({{0.0, {0.1, 0.2, 0.9, 0.01}}, {1.0, {1, 0.3, 0.1, 0.3}}}));
        RenderOptions options;
        options.size(256, 256).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
        const FloatImage picture = renderScene(volume, options);
        support::savePicture(picture, technique == VolumeAppearance::SLABS ? "first_slabs" : "first_slices");
        EXPECT_GT(picture.at(128, 128).a, 0.5f);
    }
}

} // namespace
