// Random mixed scenes at low resolution, each against its own bound.

#include "MixedScene.h"

#include <support/GLTest.h>
#include <support/Instrumented.h>

#include <cstdlib>
#include <random>

namespace MergeRandomTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::RenderOptions;

namespace {

constexpr int SCENES = support::INSTRUMENTED ? 60 : 600;
constexpr int PIXELS = 24;
constexpr int SIZE = 9; // voxels per axis

class Dice
{
public:
    explicit Dice(unsigned seed) : _engine(seed) {}
    double between(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(_engine);
    }
    int upTo(int n) { return std::uniform_int_distribution<int>(0, n)(_engine); }
    glm::dvec3 point(double low, double high)
    {
        return {between(low, high), between(low, high), between(low, high)};
    }
    glm::dvec4 color(double alphaLow, double alphaHigh)
    {
        return {between(0, 1), between(0, 1), between(0, 1), between(alphaLow, alphaHigh)};
    }
    osg::Vec3d direction()
    {
        osg::Vec3d d;
        do
            d.set(between(-1, 1), between(-1, 1), between(-1, 1));
        while (d.length2() > 1.0 || d.length2() < 0.01);
        d.normalize();
        return d;
    }

private:
    std::mt19937 _engine;
};

struct RandomScene
{
    MixedScene scene;
    RenderOptions options;
    double bound = 0.0;
};

/// A field 0.5 + 0.5 sin(k.p + phase) under a table whose opacity is at most `alpha`, linear in the
/// value.
struct Bounded
{
    double k = 0.0, alpha = 0.0;
};

/// The most that a pixel away from silhouettes may be off by, with steps of h voxels along the ray.
///
/// The midpoint rule is off by at most h^2/8 times the variation of the integrand's derivative.
/// Along a ray of length L the value v has |v'| <= k/2 and a second derivative (with the jumps of
/// v' at the faces of trilinear cells) of k^2/2. Extinction t(v) = -ln(1 - a(v)) has |t'| <= t1 =
/// alpha/(1-alpha) and |t''| <= t1^2; emission t(v) c(v), with colours c linear in v, has |(tc)'|
/// <= t1 + t and |(tc)''| <= t1^2 + 2 t1. The error of the emission shows as it is, that of the
/// optical depth times what is behind, at most 1. Within a cell of the rule the order of emission
/// and absorption is lost: h^3/12 t |(tc)'| a cell.
///
/// Overlapping volumes alternate: slab i leaves +-q_i, q = h^2/2 tA tB |cA - cB|, and an
/// alternating sum is at most half of its ends plus half of its variation. Every surface on the way
/// can start a new sum.
double boundOf(const std::vector<Bounded>& volumes, int surfaces)
{
    const double h = 1.42; // the corner of a view of 70 degrees
    const double length = (SIZE - 1) * std::sqrt(3.0);
    double bound = 2e-5; // floats
    const auto extinction = [](const Bounded& v) { return -std::log(1.0 - v.alpha); };
    const auto slope = [](const Bounded& v) { return v.alpha / (1.0 - v.alpha); };
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const Bounded& a = volumes[i];
        const double t = extinction(a), t1 = slope(a), bend = 0.5 * a.k * a.k, rate = 0.5 * a.k;
        const double depth = t1 * bend + t1 * t1 * rate * rate;
        const double emission = (t1 + t) * bend + (t1 * t1 + 2.0 * t1) * rate * rate;
        bound += length * h * h * ((depth + emission) / 8.0 + t * (t1 + t) * rate / 12.0);
        for (std::size_t k = 0; k < i; ++k) {
            const Bounded& b = volumes[k];
            const double u = extinction(b), u1 = slope(b);
            const double variation =
                length * (t1 * u * rate + t * u1 * 0.5 * b.k + t * u * (rate + 0.5 * b.k));
            bound += 0.5 * h * h * 0.5 * (t * u * 2.0 * (1 + 2 * surfaces) + variation);
        }
    }
    return bound;
}

std::unique_ptr<RandomScene> makeScene(unsigned seed)
{
    Dice dice(seed);
    auto r = std::make_unique<RandomScene>();
    const double middle = 0.5 * (SIZE - 1);
    const int volumes = 1 + dice.upTo(2);
    std::vector<Bounded> bounded;
    for (int i = 0; i < volumes; ++i) {
        const glm::dvec3 wave = dice.point(-0.25, 0.25);
        const double phase = dice.between(0, 6);
        const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), [&](const glm::dvec3& p) {
            return 0.5 + 0.5 * std::sin(glm::dot(wave, p) + phase);
        });
        const Points points = {{0.0, dice.color(0.0, 0.02)}, {1.0, dice.color(0.0, 0.12)}};
        bounded.push_back({glm::length(wave), std::max(points[0].color.a, points[1].color.a)});
        const double mirror = dice.upTo(4) == 0 ? -1.0 : 1.0;
        const osg::Matrixd place =
            i == 0 ? osg::Matrixd()
                   : osg::Matrixd::translate(-middle, -middle, -middle) *
                         osg::Matrixd::scale(mirror, 1, 1) *
                         osg::Matrixd::rotate(dice.between(0, 3), dice.direction()) *
                         osg::Matrixd::translate(middle + dice.between(-4, 4),
                                                 middle + dice.between(-4, 4),
                                                 middle + dice.between(-4, 4));
        r->scene.addVolume(voxels, points, place);
    }
    const int surfaces = dice.upTo(4);
    for (int i = 0; i < surfaces; ++i) {
        glm::dvec4 color = dice.color(0.2, 0.9);
        const bool opaque = dice.upTo(4) == 0;
        if (opaque) color.a = 1.0; // what is not blended writes its alpha as it is
        if (dice.upTo(1) == 0) {
            const glm::vec3 a(dice.point(-3, 11)), b(dice.point(-3, 11)), c(dice.point(-3, 11));
            r->scene.addQuad({a, b, b + c - a, c}, color, opaque);
        } else {
            r->scene.addMesh(sphereMesh(dice.point(0, 8), dice.between(1, 5), 10, 6), color,
                             opaque);
        }
    }
    osg::Vec3d center(middle, middle, middle), direction = dice.direction();
    osg::Vec3d up = dice.direction();
    RenderOptions& options = r->options;
    options.size(PIXELS, PIXELS);
    const int kind = dice.upTo(3);
    if (kind == 0) {
        options.orthographic(8.0).lookAt(center + direction * 40.0, center, up);
    } else if (kind == 1) { // inside
        options.perspective(70.0).lookAt(center + direction * dice.between(1.5, 6.0), center, up);
        options.computeNearFar = false;
    } else {
        options.perspective(40.0).lookAt(center + direction * 24.0, center, up);
    }
    if (dice.upTo(3) == 0) options.view = options.view * osg::Matrixd::scale(-1, 1, 1);
    r->bound = boundOf(bounded, surfaces);
    return r;
}

class MergeRandom : public support::GLTest
{
};

TEST_F(MergeRandom, NoneIsOffByMoreThanItsBound)
{
    const char* only = std::getenv("OSGVOLUMIZER_SEED"); // one scene, to look at
    const unsigned first = only ? static_cast<unsigned>(std::atoi(only)) : 0;
    const unsigned last = only ? first + 1 : SCENES;
    std::size_t pixels = 0, off = 0;
    double worst = 0.0, squares = 0.0;
    for (unsigned seed = first; seed < last; ++seed) {
        const auto scene = makeScene(seed);
        const Judged j = judge(scene->scene, scene->options);
        if (only) save(j, "merge_random");
        if (j.away.pixels == 0) continue;
        pixels += j.away.pixels;
        worst = std::max(worst, j.away.maximum / scene->bound);
        squares += j.away.rmse * j.away.rmse * double(j.away.pixels);
        if (!(j.away.maximum <= scene->bound) && ++off <= 20)
            ADD_FAILURE() << "seed " << seed << " is off by " << j.away.maximum << " at "
                          << j.away.worstX << ", " << j.away.worstY << "; bound " << scene->bound
                          << "; " << scene->scene.volumes().size() << " volumes, "
                          << scene->scene.truth().triangles.size() << " triangles";
    }
    EXPECT_GT(pixels, only ? 0u : 100u * SCENES);
    EXPECT_EQ(off, 0u);
    std::printf("  %zu pixels, rmse %.2e, worst %.2f of its bound, %zu scenes off\n", pixels,
                std::sqrt(squares / double(pixels)), worst, off);
    EXPECT_LE(std::sqrt(squares / double(pixels)), 4e-3);
}

} // namespace

} // namespace MergeRandomTest
