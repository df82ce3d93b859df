// Slices against values and colours in double precision.

#include "SliceScene.h"

#include <support/GLTest.h>
#include <support/Precision.h>
#include <support/Reports.h>

#include <osg/ClipNode>
#include <osg/Fog>

namespace SliceTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25;
const glm::dvec3 SPACING(1.0, 0.8, 1.25), ORIGIN(-3.0, 2.0, 1.0);
// Kinks and a jump; opaque.
const Points COLORS = {{0.0, {0.1, 0.2, 0.9, 1.0}},
                       {0.37, {0.9, 0.3, 0.2, 1.0}},
                       {0.37, {0.2, 0.3, 0.4, 1.0}},
                       {0.613, {0.4, 0.8, 0.1, 1.0}},
                       {1.0, {1.0, 0.5, 0.1, 1.0}}};
// Without a jump, next to which values may lie on either side.
const Points SMOOTH = {
    {0.0, {0.1, 0.2, 0.9, 0.2}}, {0.5, {0.9, 0.3, 0.2, 0.5}}, {1.0, {1.0, 0.5, 0.1, 0.9}}};

// Shows values as they are.
const Points GREY = {{0.0, {0, 0, 0, 1}}, {1.0, {1, 1, 1, 1}}};

osg::ref_ptr<Voxels> voxelsOf(int brick = 256, int overlap = 1)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    voxels->setSpacing({SPACING.x, SPACING.y, SPACING.z});
    voxels->setOrigin({ORIGIN.x, ORIGIN.y, ORIGIN.z});
    voxels->setBrickSize({brick, brick, brick});
    voxels->setOverlap(overlap);
    return voxels;
}

const glm::dvec3 LOW = ORIGIN, HIGH = ORIGIN + SPACING * (SIZE - 1.0);
const glm::dvec3 MIDDLE = 0.5 * (LOW + HIGH);

glm::dvec3 voxelAt(const glm::dvec3& place)
{
    return (place - ORIGIN) / SPACING;
}

RenderOptions view(const osg::Vec3d& eye = {50, -35, 45})
{
    return RenderOptions().size(120, 100).perspective(35.0).lookAt(eye, toOsgVec(MIDDLE),
                                                                   {0, 0, 1});
}

// What slices with some settings show.
struct Truth
{
    oracle::Grid::Interpolation how = oracle::Grid::LINEAR;
    Points points = SMOOTH;
    double thickness = 0.0, period = 0.5;
    VolumeSlice::Reduction reduction = VolumeSlice::MEAN;
    double opacity = 1.0;

    std::shared_ptr<oracle::Grid> grid = gridOf(*voxelsOf());

    double reduced(const glm::dvec3& place, const glm::dvec3& normal) const
    {
        const glm::dvec3 slab = normal * thickness;
        const int layers = std::max(1, int(std::ceil(glm::length(slab / SPACING) / period - 1e-4)));
        double sum = 0.0, low = 1e30, high = -1e30;
        int count = 0;
        for (int i = 0; i < layers; ++i) {
            const glm::dvec3 p = place + slab * ((i + 0.5) / layers - 0.5);
            if (!isWithin(p, LOW - 1e-3, HIGH + 1e-3)) continue;
            const double value = grid->value(voxelAt(p));
            sum += value;
            low = std::min(low, value);
            high = std::max(high, value);
            ++count;
        }
        return reduction == VolumeSlice::MEAN      ? sum / count
               : reduction == VolumeSlice::MAXIMUM ? high
                                                   : low;
    }
    glm::dvec4 color(const glm::dvec3& place, const glm::dvec3& normal) const
    {
        const glm::dvec3 rgb(oracle::Table(points).color(reduced(place, normal)));
        return glm::dvec4(rgb * opacity, opacity);
    }
};

const Truth GREY_TRUTH = [] {
    Truth truth;
    truth.points = GREY;
    return truth;
}();

ColorOfRay onPlane(const Truth& truth, const core::Plane& plane,
                   const std::function<bool(const glm::dvec3&)>& isShown)
{
    return [=](const glm::dvec3& o, const glm::dvec3& d) -> std::optional<glm::dvec4> {
        const glm::dvec3 p = meet(plane, o, d);
        if (!isWithin(p, LOW, HIGH) || !isShown(p)) return std::nullopt;
        return truth.color(p, plane.normal);
    };
}

bool always(const glm::dvec3&)
{
    return true;
}

osg::ref_ptr<VolumeSlice> sliceOf(const core::Plane& plane)
{
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setPlane({plane.normal.x, plane.normal.y, plane.normal.z, plane.offset});
    slice->setExactFiltering(true);
    return slice;
}

const core::Plane TILTED = planeThrough(MIDDLE + 0.3, {0.4, -0.7, 0.9});

class Slice : public support::GLTest
{
protected:
    // Of what one pixel of the edge may differ by. The bound is that of floats.
    void expectTruth(VolumeSlice* slice, Voxels* voxels, const Points& points,
                     const ColorOfRay& truth, const RenderOptions& options, double bound,
                     const std::string& name = {})
    {
        const FloatImage picture = support::renderScene(slicedOnly(voxels, points, slice), options);
        const FloatImage expected = pictureOf(options, truth);
        const SliceDifference difference = differenceOf(picture, expected);
        EXPECT_GT(difference.pixels, 150u);
        EXPECT_LT(difference.maximum, bound);
        EXPECT_LE(difference.edge, difference.pixels / 50);
        if (!name.empty()) support::savePicture(picture, name);
    }
};

} // namespace

TEST_F(Slice, OfAPlaneIsTheValueInDoublePrecision)
{
    for (const osg::Vec3d& eye : {osg::Vec3d(50, -35, 45), {10, 80, 30}, {-40, 0, -30}})
        expectTruth(sliceOf(TILTED), voxelsOf(), GREY, onPlane(GREY_TRUTH, TILTED, always),
                    view(eye), 1e-6, "slice_plane");
    RenderOptions orthographic = view();
    orthographic.orthographic(20.0);
    expectTruth(sliceOf(TILTED), voxelsOf(), GREY, onPlane(GREY_TRUTH, TILTED, always),
                orthographic, 1e-6);
}

// At a jump of the table a value may lie on either side: but for pixels there, colours are exact
// next to kinks and jumps too.
TEST_F(Slice, HasTheColoursOfTablesThatJump)
{
    Truth truth;
    truth.points = COLORS;
    const FloatImage picture =
        support::renderScene(slicedOnly(voxelsOf(), COLORS, sliceOf(TILTED)), view());
    const FloatImage expected = pictureOf(view(), onPlane(truth, TILTED, always));
    const support::Mask inner = innerPixels(picture, expected);
    std::size_t off = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        for (int c = 0; c < 4; ++c)
            off += inner.set[i] && std::abs(picture.pixels[i][c] - expected.pixels[i][c]) > 3e-6f;
    EXPECT_GT(inner.count(), 1000u);
    EXPECT_EQ(off, 0u);
}

TEST_F(Slice, InterpolatesAsAsked)
{
    Truth truth;
    truth.grid = gridOf(*voxelsOf(), oracle::Grid::CUBIC);
    osg::ref_ptr<VolumeSlice> slice = sliceOf(TILTED);
    slice->setInterpolation(A::CUBIC);
    expectTruth(slice, voxelsOf(10, 3), SMOOTH, onPlane(truth, TILTED, always), view(), 2e-6);
    truth.grid = gridOf(*voxelsOf(), oracle::Grid::NEAREST);
    // Between samples: a value is that of one or the other.
    const core::Plane between = planeThrough(MIDDLE + glm::dvec3(0, 0, 0.2), {0, 0, 1});
    slice = sliceOf(between);
    slice->setInterpolation(A::NEAREST);
    const FloatImage picture = support::renderScene(slicedOnly(voxelsOf(), SMOOTH, slice), view());
    const FloatImage expected = pictureOf(view(), onPlane(truth, between, always));
    const support::Mask inner = innerPixels(picture, expected);
    std::size_t off = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        off += inner.set[i] && std::abs(picture.pixels[i].r - expected.pixels[i].r) > 1e-6f;
    EXPECT_GT(inner.count(), 500u);
    EXPECT_LE(off, 2u);
    slice->setInterpolation(A::LINEAR);
    slice->setExactFiltering(false);
    if (support::filtersExactly())
        expectTruth(slice, voxelsOf(), SMOOTH, onPlane(Truth(), between, always), view(), 4e-6);
}

TEST_F(Slice, OfAPolygonThatIsNotConvexIsCutOut)
{
    // An arrowhead in the tilted plane.
    const glm::dvec3 u = glm::normalize(glm::cross(TILTED.normal, glm::dvec3(0, 0, 1)));
    const glm::dvec3 v = glm::cross(TILTED.normal, u), at = meet(TILTED, MIDDLE, TILTED.normal);
    const std::vector<glm::dvec2> flat = {{-7, -6}, {0, 8}, {7, -6}, {0, -1}};
    std::vector<osg::Vec3d> corners;
    for (const glm::dvec2& c : flat)
        corners.push_back(toOsgVec(at + c.x * u + c.y * v));
    const auto isInside = [&](const glm::dvec3& p) {
        const glm::dvec2 q(glm::dot(p - at, u), glm::dot(p - at, v));
        bool inside = false;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const glm::dvec2 a = flat[i], b = flat[(i + 1) % flat.size()];
            if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x))
                inside = !inside;
        }
        return inside;
    };
    for (int turn = 0; turn < 2; ++turn) {
        osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
        ASSERT_TRUE(slice->setPolygon(corners));
        slice->setExactFiltering(true);
        expectTruth(slice, voxelsOf(9), GREY, onPlane(GREY_TRUTH, TILTED, isInside), view(), 1e-6,
                    "slice_polygon");
        std::reverse(corners.begin(), corners.end());
    }
}

TEST_F(Slice, OfAGeometryIsTheValueOnItsTriangles)
{
    // A tent: two planes that meet in a ridge, wider than the voxels.
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    const double z = MIDDLE.z;
    for (const double y : {LOW.y - 3.0, HIGH.y + 2.0})
        for (const auto& [x, h] :
             {std::pair(LOW.x - 1.0, -5.0), {MIDDLE.x, 8.0}, {HIGH.x + 4.0, -6.0}})
            points->push_back(osg::Vec3d(x, y, z + h));
    osg::ref_ptr<osg::Geometry> tent = new osg::Geometry;
    tent->setVertexArray(points);
    osg::ref_ptr<osg::DrawElementsUShort> strip = new osg::DrawElementsUShort(GL_TRIANGLE_STRIP);
    for (const unsigned short i : {0, 3, 1, 4, 2, 5})
        strip->push_back(i);
    tent->addPrimitiveSet(strip);
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    ASSERT_TRUE(slice->setGeometry(tent));
    slice->setExactFiltering(true);
    const auto at = [&](std::size_t i) {
        const osg::Vec3& p = (*points)[i];
        return glm::dvec3(p.x(), p.y(), p.z());
    };
    const core::Plane left = planeThrough(at(0), glm::cross(at(1) - at(0), at(3) - at(0)));
    const core::Plane right = planeThrough(at(1), glm::cross(at(2) - at(1), at(4) - at(1)));
    const Truth truth = GREY_TRUTH;
    const ColorOfRay color = [&](const glm::dvec3& o,
                                 const glm::dvec3& d) -> std::optional<glm::dvec4> {
        const glm::dvec3 l = meet(left, o, d), r = meet(right, o, d);
        const bool onLeft = l.x <= MIDDLE.x && isWithin(l, LOW, HIGH);
        const bool onRight = r.x >= MIDDLE.x && isWithin(r, LOW, HIGH);
        if (!onLeft && !onRight) return std::nullopt;
        // Whose pixel one on the ridge is, rasterisers may say.
        if (std::min(std::abs(l.x - MIDDLE.x), std::abs(r.x - MIDDLE.x)) < 0.02)
            return std::nullopt;
        const bool leftFirst = !onRight || (onLeft && glm::dot(l - r, d) < 0.0);
        return leftFirst ? truth.color(l, left.normal) : truth.color(r, right.normal);
    };
    expectTruth(slice, voxelsOf(7), GREY, color, view({15, -30, 75}), 1e-6, "slice_geometry");
}

TEST_F(Slice, OfASlabIsTheMeanTheLargestAndTheSmallest)
{
    for (const auto reduction : {VolumeSlice::MEAN, VolumeSlice::MAXIMUM, VolumeSlice::MINIMUM})
        for (const int brick : {256, 9}) {
            Truth truth = GREY_TRUTH;
            truth.thickness = 6.3;
            truth.reduction = reduction;
            osg::ref_ptr<VolumeSlice> slice = sliceOf(TILTED);
            ASSERT_TRUE(slice->setThickness(truth.thickness));
            slice->setReduction(reduction);
            expectTruth(slice, voxelsOf(brick), GREY, onPlane(truth, TILTED, always), view(), 1e-6,
                        "slice_slab" + std::to_string(reduction));
        }
}

TEST_F(Slice, TakesAWindowOrItsOwnTable)
{
    osg::ref_ptr<VolumeSlice> slice = sliceOf(TILTED);
    ASSERT_TRUE(slice->setWindow(0.55, 0.5));
    Truth truth;
    truth.points = {{0.3, {0, 0, 0, 1}}, {0.8, {1, 1, 1, 1}}};
    expectTruth(slice, voxelsOf(), SMOOTH, onPlane(truth, TILTED, always), view(), 2e-6);
    truth.points = {{0.0, {1, 0, 0, 1}}, {1.0, {0, 1, 0, 1}}};
    slice->setLookupTable(makeTable(truth.points));
    EXPECT_FALSE(slice->getWindow());
    expectTruth(slice, voxelsOf(), SMOOTH, onPlane(truth, TILTED, always), view(), 1e-6);
}

TEST_F(Slice, BlendsWithItsOpacityOrTheTables)
{
    osg::ref_ptr<VolumeSlice> slice = sliceOf(TILTED);
    ASSERT_TRUE(slice->setOpacity(0.4));
    Truth truth;
    truth.opacity = 0.4;
    expectTruth(slice, voxelsOf(), SMOOTH, onPlane(truth, TILTED, always), view(), 1e-6);
    slice->setUsesTableOpacity(true);
    const ColorOfRay color = [&](const glm::dvec3& o,
                                 const glm::dvec3& d) -> std::optional<glm::dvec4> {
        const glm::dvec3 p = meet(TILTED, o, d);
        if (!isWithin(p, LOW, HIGH)) return std::nullopt;
        const glm::dvec4 c = oracle::Table(SMOOTH).color(truth.grid->value(voxelAt(p)));
        return glm::dvec4(glm::dvec3(c) * c.a * 0.4, c.a * 0.4);
    };
    expectTruth(slice, voxelsOf(), SMOOTH, color, view(), 1e-6, "slice_translucent");
}

// Bricks are drawn from one by one; what one shows on its faces the next one does too.
TEST_F(Slice, HasNoSeamsBetween64Bricks)
{
    const osg::ref_ptr<Voxels> bricks = voxelsOf(7), one = voxelsOf();
    ASSERT_EQ(bricks->getLayout().brickCount(), 64);
    for (const double thickness : {0.0, 9.0})
        for (const core::Plane& plane :
             {TILTED, planeThrough(MIDDLE, {0, 0, 1}), planeThrough(LOW, {1, 0, 0}),
              planeThrough(HIGH, {0, 1, 0})}) {
            osg::ref_ptr<VolumeSlice> slice = sliceOf(plane);
            slice->setThickness(thickness);
            const FloatImage a = support::renderScene(slicedOnly(bricks, SMOOTH, slice), view());
            const FloatImage b = support::renderScene(slicedOnly(one, SMOOTH, slice), view());
            EXPECT_GT(support::coveredPixels(b).count(), 500u);
            // Rasterisers may disagree on pixels at the border.
            const support::Mask inner = support::eroded(support::coveredPixels(b), 1);
            EXPECT_LT(support::compare(a, b, inner).maximum, 3e-6)
                << thickness << " " << plane.normal.x << plane.normal.y;
        }
}

// A plane between two bricks, and those on the faces of all voxels, are whole.
TEST_F(Slice, OnTheFacesOfBricksIsWhole)
{
    for (int k = 0; k < SIZE; ++k) {
        const core::Plane plane =
            planeThrough(ORIGIN + SPACING * glm::dvec3(0, 0, k), {0, 0, k % 2 ? 1 : -1});
        const FloatImage picture = support::renderScene(
            slicedOnly(voxelsOf(7), SMOOTH, sliceOf(plane)), view({10, 12, 90}));
        const FloatImage expected =
            pictureOf(view({10, 12, 90}),
                      [&](const glm::dvec3& o, const glm::dvec3& d) -> std::optional<glm::dvec4> {
                          const glm::dvec3 p = meet(plane, o, d);
                          if (!isWithin(p, LOW - 1e-9, HIGH + 1e-9)) return std::nullopt;
                          return glm::dvec4(1.0);
                      });
        const support::Mask hole = support::eroded(support::coveredPixels(expected), 1);
        EXPECT_EQ((hole & support::coveredPixels(picture)).count(), hole.count()) << k;
    }
}

// Fog and clip planes, as on any surface.
TEST_F(Slice, IsInFogAndCutByClipPlanes)
{
    const core::Plane cut = planeThrough(MIDDLE, {1, 0.3, 0});
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(
        new osg::ClipPlane(2, osg::Vec4d(cut.normal.x, cut.normal.y, cut.normal.z, cut.offset)));
    clip->addChild(slicedOnly(voxelsOf(9), SMOOTH, sliceOf(TILTED)));
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::LINEAR);
    fog->setStart(50.0f);
    fog->setEnd(110.0f);
    fog->setColor(osg::Vec4(0.2f, 0.7f, 0.4f, 1.0f));
    clip->getOrCreateStateSet()->setAttributeAndModes(fog);
    const FloatImage picture = support::renderScene(clip, view());
    const glm::dvec3 eye(50, -35, 45), ahead = glm::normalize(MIDDLE - eye);
    const Truth truth;
    const FloatImage expected = pictureOf(
        view(), [&](const glm::dvec3& o, const glm::dvec3& d) -> std::optional<glm::dvec4> {
            const glm::dvec3 p = meet(TILTED, o, d);
            if (!isWithin(p, LOW, HIGH) || cut.distance(p) < 0.0) return std::nullopt;
            const double share = (110.0 - glm::dot(p - eye, ahead)) / 60.0;
            const glm::dvec3 color(truth.color(p, TILTED.normal));
            return glm::dvec4(glm::mix(glm::dvec3(glm::vec3(0.2f, 0.7f, 0.4f)), color, share), 1);
        });
    const SliceDifference difference = differenceOf(picture, expected);
    EXPECT_GT(difference.pixels, 500u);
    EXPECT_LT(difference.maximum, 2e-6);
    EXPECT_LE(difference.edge, difference.pixels / 50);
}

// Only bricks that are touched are read.
TEST_F(Slice, ReadsWhatItTouches)
{
    const osg::ref_ptr<Voxels> voxels = voxelsOf(7);
    const core::Plane plane = planeThrough(LOW + glm::dvec3(0, 0, 4.0), {0, 0, 1});
    EXPECT_FALSE(support::renderScene(slicedOnly(voxels, SMOOTH, sliceOf(plane)), view()).empty());
    EXPECT_EQ(voxels->getReadCount(), 16u);
    // A slab reaches into the next layer of bricks.
    const osg::ref_ptr<VolumeSlice> slab = sliceOf(plane);
    slab->setThickness(9.0);
    EXPECT_FALSE(support::renderScene(slicedOnly(voxels, SMOOTH, slab), view()).empty());
    EXPECT_EQ(voxels->getReadCount(), 32u);
}

TEST_F(Slice, UploadsNothingThatAVolumeHas)
{
    const osg::ref_ptr<Voxels> voxels = voxelsOf(9);
    for (const bool joining : {false, true}) {
        const osg::ref_ptr<A> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(SMOOTH));
        support::SceneRenderer renderer(volume, support::joining(view(), joining));
        renderer.render();
        EXPECT_GT(renderer.counters()["osgVolumizer bricks uploaded"], 0.0);
        volume->addChild(sliceOf(TILTED));
        renderer.render();
        EXPECT_EQ(renderer.counters()["osgVolumizer bricks uploaded"], 0.0) << joining;
        EXPECT_GT(renderer.counters()["osgVolumizer slice bricks"], 0.0);
    }
}

} // namespace SliceTest
