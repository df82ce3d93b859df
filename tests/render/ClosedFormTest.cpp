// Pictures of volumes whose integrals are known, against the closed form and the oracle.

#include "Volumes.h"

#include <oracles/ClosedForms.h>
#include <oracles/Ray.h>
#include <support/GLTest.h>
#include <support/Precision.h>

#include <cmath>

namespace ClosedFormTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis

struct Case
{
    VolumeAppearance::Technique technique;
    bool perspective;
};

std::string nameOf(const ::testing::TestParamInfo<Case>& info)
{
    return std::string(info.param.technique == VolumeAppearance::SLABS ? "Slabs" : "Slices") +
           (info.param.perspective ? "Perspective" : "Orthographic");
}

// Views of the box of SIZE^3 voxels: a wide perspective one, and a parallel one.
RenderOptions viewOf(const Case& c)
{
    RenderOptions options;
    options.size(96, 96);
    if (c.perspective)
        options.perspective(60.0).lookAt({46, -14, 38}, {16, 16, 16}, {0, 0, 1});
    else
        options.orthographic(27.0).lookAt({70, -40, 60}, {16, 16, 16}, {0, 0, 1});
    return options;
}

class ClosedForm : public support::GLTest, public ::testing::WithParamInterface<Case>
{
protected:
    FloatImage picture(TwinVolume& twin, double period) const
    {
        twin.node->setTechnique(GetParam().technique);
        support::filterExactly(*twin.node); // for the order of sampling
        twin.setPeriod(period);
        return support::renderScene(twin.node, viewOf(GetParam()));
    }

    FloatImage expected(const oracle::Volume& volume) const
    {
        return oraclePicture(oracleScene(volume), viewOf(GetParam()));
    }

    support::Mask away(const oracle::Volume& volume) const
    {
        return awayFromSilhouettes(oracleScene(volume), viewOf(GetParam()));
    }

    bool slabs() const { return GetParam().technique == VolumeAppearance::SLABS; }

    void save(const FloatImage& image, const std::string& name) const
    {
        support::savePicture(image, "closed_form_" + name + "_" + nameOf({GetParam(), 0}));
    }
};

TEST_P(ClosedForm, ConstantBox)
{
    const glm::dvec4 color(0.9, 0.5, 0.1, 0.03);
    osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.5; });
    TwinVolume twin = makeTwin(voxels, constantPoints(color));
    // The closed form from nothing but the length of each ray in the box.
    const oracle::Camera camera = support::oracleCamera(viewOf(GetParam()));
    FloatImage closed(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            oracle::Crossing crossing;
            const oracle::Ray ray = oracle::rayThrough(camera, x + 0.5, y + 0.5);
            if (oracle::cross(ray, camera, twin.oracle, crossing))
                closed.at(x, y) = oracle::constantSegment(color, (crossing.leave - crossing.enter) *
                                                                     crossing.objectLength);
        }
    std::vector<double> steps, errors;
    for (double period = 1.0; period > 0.2; period *= 0.5) {
        const FloatImage image = picture(twin, period);
        steps.push_back(period);
        errors.push_back(compare(image, closed).rmse);
        if (period == 0.25) save(image, "constant");
    }
    EXPECT_LE(errors.back(), 2e-3);
    if (slabs())
        EXPECT_LE(compare(picture(twin, 1.0), closed, away(twin.oracle)).maximum,
                  1e-5); // exact but for floats, whatever the period
    else
        EXPECT_GE(support::convergenceOrder(steps, errors), 0.9);
}

TEST_P(ClosedForm, RampAlongTheBox)
{
    // Opacity and colour rise with x, y and z: no symmetry hides a swapped axis.
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) {
        return (p.x + 0.6 * p.y + 0.3 * p.z) / 32.0 / 1.9;
    });
    TwinVolume twin =
        makeTwin(voxels, {{0.0, {0.0, 0.3, 1.0, 0.005}}, {1.0, {1.0, 0.6, 0.0, 0.06}}});
    // Not the samples of the ramp, but the ramp itself.
    oracle::Volume ramp = twin.oracle;
    ramp.field = std::make_shared<oracle::RampField>(glm::dvec3(1.0, 0.6, 0.3) / 32.0 / 1.9, 0.0);
    const FloatImage closed = expected(ramp);
    const support::Mask inside = away(ramp);
    std::vector<double> steps, errors, maxima;
    for (double period = slabs() ? 8.0 : 1.0; period > 0.2; period *= 0.5) {
        const FloatImage image = picture(twin, period);
        steps.push_back(period);
        errors.push_back(compare(image, closed).rmse);
        maxima.push_back(compare(image, closed, inside).maximum);
        if (period == 0.25) save(image, "ramp");
    }
    EXPECT_LE(errors.back(), 2e-3);
    if (slabs()) {
        EXPECT_LE(maxima.back(), 1e-5);
        for (auto* list : {&steps, &errors, &maxima})
            list->pop_back(); // meets the round-off of floats
    }
    EXPECT_GE(support::convergenceOrder(steps, errors), slabs() ? 1.9 : 0.9);
    EXPECT_GE(support::convergenceOrder(steps, maxima), slabs() ? 1.9 : 0.9);
}

TEST_P(ClosedForm, GaussianBlob)
{
    // Off the middle, so that the box cuts it where it is steep: those ends decide the order.
    const auto blob = std::make_shared<oracle::GaussianField>(glm::dvec3(20, 12, 24), 9.0);
    osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [&](const glm::dvec3& p) { return blob->value(p); });
    const Points points = {{0.0, {0.1, 0.2, 0.9, 0.01}}, {1.0, {1.0, 0.3, 0.1, 0.2}}};
    TwinVolume twin = makeTwin(voxels, points);
    const FloatImage sampled = expected(twin.oracle);
    std::vector<double> steps, errors;
    FloatImage image;
    for (double period = 4.0; period > 0.2; period *= 0.5) {
        image = picture(twin, period);
        steps.push_back(period);
        errors.push_back(compare(image, sampled).rmse);
    }
    save(image, "gaussian");
    EXPECT_LE(errors.back(), 2e-3);
    EXPECT_GE(support::convergenceOrder(steps, errors), slabs() ? 1.9 : 0.9);

    // The blob itself: off by what trilinear voxels lose.
    oracle::Volume smooth = twin.oracle;
    smooth.field = blob;
    EXPECT_LE(compare(image, expected(smooth)).rmse, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Techniques, ClosedForm,
                         ::testing::Values(Case{VolumeAppearance::SLABS, true},
                                           Case{VolumeAppearance::SLABS, false},
                                           Case{VolumeAppearance::SLICES, true},
                                           Case{VolumeAppearance::SLICES, false}),
                         nameOf);

} // namespace

} // namespace ClosedFormTest
