// What VolumeAppearance::setErrorTolerance() promises is kept whatever is shown, and at a fair
// price.

#include "PromiseCases.h"

#include <support/Choices.h>
#include <support/GLTest.h>
#include <support/Instrumented.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

namespace PromiseTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr double TOLERANCES[] = {1e-2, 1e-3, 1e-4};

// A case is drawn in one context, whose views and settings change.
class Examiner
{
public:
    explicit Examiner(PromiseCase& subject)
        : _case(subject), _renderer(subject.twin.node, subject.views.front())
    {
        oracle::Scene scene = oracleScene(subject.twin.oracle);
        scene.tolerance = 1e-8; // rays are then good to 1e-7, see SharpTableTest
        for (const RenderOptions& options : subject.views) {
            _expected.push_back(oraclePicture(scene, options));
            _covered.push_back(support::coveredPixels(_expected.back(), 1e-3f));
        }
    }

    /// Root mean square error of a view over the pixels that show something.
    double error(std::size_t view)
    {
        return compare(render(view, false), _expected[view], _covered[view]).rmse;
    }
    /// The largest of all views; that of the first one above `enough`.
    double worstError(double enough = INFINITY)
    {
        double worst = 0.0;
        for (std::size_t view = 0; view < _expected.size() && worst <= enough; ++view)
            worst = std::max(worst, error(view));
        return worst;
    }
    /// In all views.
    double samples()
    {
        double sum = 0.0;
        for (std::size_t view = 0; view < _expected.size(); ++view)
            for (const glm::vec4& pixel : render(view, true).pixels)
                sum += pixel.r;
        return sum;
    }
    std::size_t viewCount() const { return _expected.size(); }

private:
    FloatImage render(std::size_t view, bool countSamples)
    {
        _renderer.options() = _case.views[view];
        support::viewHooks(_renderer.viewer()).countSamples = countSamples;
        return _renderer.render();
    }

    PromiseCase& _case;
    support::SceneRenderer _renderer;
    std::vector<FloatImage> _expected;
    std::vector<support::Mask> _covered;
};

double expectedError(const PromiseCase& c)
{
    const auto& geometry = dynamic_cast<const VolumeGeometry&>(*c.twin.node->getChild(0));
    return c.twin.node->getSettingsInForce(geometry).expectedError;
}

std::string describe(const PromiseCase& c, double tolerance)
{
    std::ostringstream text;
    text << "case " << c.number << ", " << c.table << " of " << c.field << ", tolerance "
         << tolerance;
    return text.str();
}

// Cases part, part + PARTS, and so on, so that the slow ones are spread.
constexpr int PARTS = 8;

class Promise : public support::GLTest, public ::testing::WithParamInterface<int>
{
};

TEST_P(Promise, IsKept)
{
    const int step = support::INSTRUMENTED ? 9 * PARTS : PARTS;
    int said = 0;
    for (int number = GetParam(); number < PROMISE_CASES; number += step) {
        PromiseCase c = makePromiseCase(number);
        Examiner examiner(c);
        for (const double tolerance : TOLERANCES) {
            ASSERT_TRUE(c.twin.node->setErrorTolerance(tolerance));
            const double before = examiner.error(0); // a choice is made
            ASSERT_TRUE(support::waitForChoice(*c.twin.node));
            // What cannot be kept is said, with how near it comes.
            const double kept = std::max(tolerance, expectedError(c));
            EXPECT_LE(before, kept) << describe(c, tolerance) << ", before a choice is made";
            said += kept > tolerance;
            double worst = 0.0;
            for (std::size_t view = 0; view < examiner.viewCount(); ++view) {
                const double error = examiner.error(view);
                EXPECT_LE(error, kept) << describe(c, tolerance) << ", view " << view;
                worst = std::max(worst, error);
            }
            std::ostringstream result;
            result << c.table << "; " << c.field << "; error " << worst;
            RecordProperty("case " + std::to_string(number) + ", tolerance " +
                               std::to_string(tolerance),
                           result.str());
        }
    }
    EXPECT_LE(said, 1);
}

INSTANTIATE_TEST_SUITE_P(Parts, Promise, ::testing::Range(0, PARTS));

// A way to sample that can be fixed by hand.
struct Way
{
    const char* name;
    void (*apply)(VolumeAppearance& node, double periodVoxel);
};

void applyLookup(VolumeAppearance& node, VolumeAppearance::Lookup lookup, double periodVoxel)
{
    node.setLookup(lookup);
    node.setSamplingPeriod({periodVoxel, periodVoxel, periodVoxel});
}

const Way WAYS[] = {{"after interpolation",
                     [](VolumeAppearance& node, double periodVoxel) {
                         applyLookup(node, VolumeAppearance::AFTER_INTERPOLATION, periodVoxel);
                     }},
                    {"preintegrated",
                     [](VolumeAppearance& node, double periodVoxel) {
                         applyLookup(node, VolumeAppearance::PREINTEGRATED, periodVoxel);
                     }},
                    {"cell by cell", [](VolumeAppearance& node, double periodVoxel) {
                         applyLookup(node, VolumeAppearance::CELL_BY_CELL, periodVoxel);
                     }}};

// What is found by trying everything.
struct Best
{
    double samples = INFINITY; ///< the fewest that keep a tolerance in all views
    const char* way = "none";
    double periodVoxel = 0.0;
};

// For each tolerance. A way's period is the longest of a geometric sequence that keeps it.
std::vector<Best> findBest(PromiseCase& c, Examiner& examiner)
{
    constexpr double LONGEST = 8.0, SHORTEST = 1.0 / 16.0, RATIO = 0.8; // as may be chosen
    std::vector<Best> best(std::size(TOLERANCES));
    c.twin.node->setErrorTolerance(0.0);
    for (const Way& way : WAYS) {
        std::size_t next = 0; // tolerance to be kept, which descend
        for (double period = LONGEST; period > SHORTEST && next < best.size(); period *= RATIO) {
            way.apply(*c.twin.node, period);
            const double error = examiner.worstError(TOLERANCES[next]);
            if (error > TOLERANCES[next]) continue;
            const double samples = examiner.samples();
            for (; next < best.size() && error <= TOLERANCES[next]; ++next)
                if (samples < best[next].samples) best[next] = {samples, way.name, period};
        }
    }
    return best;
}

// All kinds of tables and of fields.
constexpr int COST_CASES[] = {0, 7, 15, 28, 29, 66, 71, 89, 103, 106, 140, 192};

using PromiseCost = support::GLTest;

// What is chosen for all views before any is drawn, against what turns out to do for three of them.
TEST_F(PromiseCost, IsNearTheLeast)
{
    if (support::INSTRUMENTED) return; // takes minutes, and is the same code with other numbers
    double sum = 0.0;
    int count = 0;
    for (const int number : COST_CASES) {
        PromiseCase c = makePromiseCase(number);
        Examiner examiner(c);
        std::vector<double> chosen;
        for (const double tolerance : TOLERANCES) {
            ASSERT_TRUE(c.twin.node->setErrorTolerance(tolerance));
            ASSERT_TRUE(support::waitForChoice(*c.twin.node));
            chosen.push_back(examiner.samples());
        }
        const std::vector<Best> best = findBest(c, examiner);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            // Where none of the fixed choices does, nothing is too much.
            if (!std::isfinite(best[i].samples)) continue;
            const double ratio = chosen[i] / best[i].samples;
            std::printf("  %s: %.2f times %s with a period of %.2f\n",
                        describe(c, TOLERANCES[i]).c_str(), ratio, best[i].way,
                        best[i].periodVoxel);
            EXPECT_LT(ratio, 8.0) << describe(c, TOLERANCES[i]);
            sum += std::log(ratio);
            ++count;
        }
    }
    ASSERT_GT(count, 30);
    std::printf("  mean %.3f\n", std::exp(sum / count));
    EXPECT_LT(std::exp(sum / count), 1.4);
}

} // namespace

} // namespace PromiseTest
