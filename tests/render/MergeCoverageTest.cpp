// Surfaces cut by the borders of depth intervals: every pixel of a surface is drawn once, and shows
// no band. The volume is as good as transparent, so that nothing but the surface decides a pixel.

#include "MixedScene.h"

#include <support/GLTest.h>

#include <osg/Depth>

#include <random>

namespace MergeCoverageTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33;      // voxels per axis
constexpr float ONCE = 0.25f; // what one fragment adds

class Coverage : public support::GLTest
{
protected:
    Coverage()
    {
        _volume = makeVolume(makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.5; }));
        _volume->setLookupTable(makeTable(constantPoints({1.0, 1.0, 1.0, 1e-7})));
        _volume->setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25));
    }

    struct Count
    {
        std::size_t covered = 0, missed = 0, doubled = 0, intervals = 0;
    };

    // Pixels of `surface` that are not drawn as often as without the volume.
    Count count(osg::Node* surface, const RenderOptions& options, const std::string& name) const
    {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(surface);
        const FloatImage plain = support::renderScene(scene, options);
        scene->addChild(_volume);
        support::SceneRenderer renderer(scene, options);
        const FloatImage merged = renderer.render();
        Count c;
        c.intervals = static_cast<std::size_t>(renderer.counters()["osgVolumizer intervals"]);
        for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
            const float before = plain.pixels[i].r, after = merged.pixels[i].r;
            c.covered += before > 0.0f;
            c.missed += after < before - 0.5f * ONCE;
            c.doubled += after > before + 0.5f * ONCE;
        }
        if (c.missed + c.doubled) support::savePicture(merged, name);
        return c;
    }

    osg::ref_ptr<VolumeAppearance> _volume;
};

osg::ref_ptr<osg::Geometry> additive(const Mesh& mesh)
{
    osg::ref_ptr<osg::Geometry> geometry = makeGeometry(mesh, glm::dvec4(ONCE));
    geometry->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
    geometry->getOrCreateStateSet()->setAttributeAndModes(
        new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
    return geometry;
}

RenderOptions viewFrom(std::mt19937& random, bool perspective)
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    osg::Vec3d direction;
    do
        direction.set(unit(random), unit(random), unit(random));
    while (direction.length2() > 1.0 || direction.length2() < 0.01);
    direction.normalize();
    const osg::Vec3d middle(16, 16, 16);
    RenderOptions options;
    options.size(384, 384).lookAt(middle + direction * 75.0, middle, {0.3, 0.4, 0.5});
    return perspective ? options.perspective(35.0) : options.orthographic(24.0);
}

TEST_F(Coverage, SlantedQuadsAreDrawnOnce)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-6.0f, 38.0f);
    Count total;
    for (int i = 0; i < 60; ++i) {
        // A parallelogram in any direction.
        const auto point = [&] { return glm::vec3(place(random), place(random), place(random)); };
        const glm::vec3 a = point(), b = point(), c = point();
        const RenderOptions options = viewFrom(random, i % 2 == 0);
        const Count n =
            count(additive(quadMesh({a, b, b + c - a, c})), options, "merge_coverage_quad");
        if (n.missed + n.doubled)
            std::printf("  %d: %zu covered, %zu missed, %zu doubled, %zu intervals\n", i, n.covered,
                        n.missed, n.doubled, n.intervals);
        total.covered += n.covered;
        total.missed += n.missed;
        total.doubled += n.doubled;
        total.intervals += n.intervals;
    }
    std::printf("  %zu pixels, %zu intervals: %zu missed, %zu doubled\n", total.covered,
                total.intervals, total.missed, total.doubled);
    EXPECT_GE(total.covered, 100000u);
    EXPECT_EQ(total.missed, 0u);
    EXPECT_EQ(total.doubled, 0u);
}

TEST_F(Coverage, SpheresAreDrawnOnce)
{
    std::mt19937 random(12);
    Count total;
    for (int i = 0; i < 10; ++i) {
        const RenderOptions options = viewFrom(random, i % 2 == 0);
        const Count n = count(additive(sphereMesh({16, 17, 15}, 12.0, 60, 30)), options,
                              "merge_coverage_sphere");
        total.covered += n.covered;
        total.missed += n.missed;
        total.doubled += n.doubled;
        total.intervals += n.intervals;
    }
    std::printf("  %zu pixels, %zu intervals: %zu missed, %zu doubled\n", total.covered,
                total.intervals, total.missed, total.doubled);
    EXPECT_GE(total.covered, 100000u);
    EXPECT_EQ(total.missed, 0u);
    EXPECT_EQ(total.doubled, 0u);
}

} // namespace

} // namespace MergeCoverageTest
