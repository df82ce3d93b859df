// Slices in scenes: among volumes and surfaces, picked, paged, laid flat, drawn by applications.

#include "SliceScene.h"
#include "PagedScene.h"

#include <osgVolumizer/CurvedStrip.h>

#include <support/GLTest.h>
#include <support/Precision.h>
#include <support/Reports.h>
#include <support/Shapes.h>

#include <osg/MatrixTransform>
#include <osg/Program>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/Optimizer>

#include <cmath>

namespace SliceSceneTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25;
constexpr double MIDDLE = 12.0;
const Points GREY = {{0.0, {0, 0, 0, 1}}, {1.0, {1, 1, 1, 1}}};

RenderOptions view(const osg::Vec3d& eye = {50, -35, 45})
{
    return RenderOptions().size(100, 90).perspective(35.0).lookAt(eye, {MIDDLE, MIDDLE, MIDDLE},
                                                                  {0, 0, 1});
}

osg::ref_ptr<Voxels> voxelsOf(int brick = 256)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    voxels->setBrickSize({brick, brick, brick});
    return voxels;
}

// A polygon of one colour, as a slice and as a quad of OSG's.
const std::vector<osg::Vec3d> CORNERS = {{3, 4, 5}, {20, 4, 8}, {20, 21, 17}, {3, 21, 14}};

osg::ref_ptr<VolumeSlice> coloured(const osg::Vec4& color)
{
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    EXPECT_TRUE(slice->setPolygon(CORNERS));
    slice->setLookupTable(makeTable(constantPoints({color.r(), color.g(), color.b(), 1.0})));
    slice->setOpacity(color.a());
    return slice;
}

osg::ref_ptr<osg::Geometry> quadOf(const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> quad = support::makeQuad({}, color, color.a() < 1.0f);
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (const osg::Vec3d& corner : CORNERS)
        points->push_back(corner);
    quad->setVertexArray(points);
    return quad;
}

class SliceScene : public support::GLTest
{
};

// How far a volume with a slice is from one with a quad.
double fromQuad(const osg::Vec4& color, A::Technique technique, const std::string& name)
{
    const auto sceneOf = [&](osg::Node* surface) {
        const osg::ref_ptr<A> volume = makeVolume(voxelsOf(9));
        volume->setLookupTable(makeTable(smoothPoints(0.1)));
        volume->setTechnique(technique);
        volume->addChild(surface);
        return support::renderScene(volume, view());
    };
    const FloatImage slice = sceneOf(coloured(color)), quad = sceneOf(quadOf(color));
    support::savePicture(slice, name);
    // What is beside the surface, on which rasterisers may disagree at the border.
    FloatImage apart(quad.width, quad.height);
    osg::ref_ptr<osg::Group> none = new osg::Group;
    const FloatImage volume = sceneOf(none);
    std::size_t differing = 0, inside = 0;
    double largest = 0.0;
    for (std::size_t i = 0; i < quad.pixels.size(); ++i) {
        const glm::vec4 d = glm::abs(slice.pixels[i] - quad.pixels[i]);
        const float off = std::max({d.r, d.g, d.b, d.a});
        inside += quad.pixels[i] != volume.pixels[i];
        if (off > 1e-3f)
            ++differing;
        else
            largest = std::max(largest, double(off));
    }
    EXPECT_GT(inside, 400u);
    EXPECT_LE(differing, 6u);
    return largest;
}

} // namespace

TEST_F(SliceScene, EndsVolumesAsAQuadDoes)
{
    EXPECT_LT(fromQuad({0.9f, 0.2f, 0.3f, 1.0f}, A::SLABS, "slice_in_volume"), 1e-5);
    EXPECT_LT(fromQuad({0.9f, 0.2f, 0.3f, 1.0f}, A::SLICES, "slice_in_slices"), 1e-5);
}

TEST_F(SliceScene, IsMergedWithVolumesWhereItIsTranslucent)
{
    EXPECT_LT(fromQuad({0.9f, 0.2f, 0.3f, 0.5f}, A::SLABS, "slice_translucent_in_volume"), 1e-3);
    EXPECT_LT(fromQuad({0.9f, 0.2f, 0.3f, 0.5f}, A::SLICES, "slice_translucent_in_slices"), 1e-3);
}

TEST_F(SliceScene, IsPickedAndHasBounds)
{
    const osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setPlane(osg::Vec3d(12, 12, 7), osg::Vec3d(0, 0, 2));
    osg::ref_ptr<osg::MatrixTransform> moved =
        new osg::MatrixTransform(osg::Matrixd::translate(100, 0, 0));
    const osg::ref_ptr<A> appearance = slicedOnly(voxelsOf(), GREY, slice);
    moved->addChild(appearance);
    const osg::BoundingBox box = slice->getBoundingBox();
    EXPECT_NEAR(box.xMin(), 0.0, 1e-5);
    EXPECT_NEAR(box.xMax(), 24.0, 1e-5);
    EXPECT_NEAR(box.zMin(), 7.0, 1e-5);
    EXPECT_NEAR(box.zMax(), 7.0, 1e-5);
    osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(105, 6, 50), osg::Vec3d(105, 6, -50));
    osgUtil::IntersectionVisitor visitor(line);
    moved->accept(visitor);
    ASSERT_TRUE(line->containsIntersections());
    const auto hit = line->getFirstIntersection();
    EXPECT_EQ(hit.drawable.get(), slice.get());
    EXPECT_NEAR((hit.getWorldIntersectPoint() - osg::Vec3d(105, 6, 7)).length(), 0.0, 1e-5);
    line->reset();
    line->setStart(osg::Vec3d(130, 6, 50));
    line->setEnd(osg::Vec3d(130, 6, -50));
    moved->accept(visitor);
    EXPECT_FALSE(line->containsIntersections());
}

TEST_F(SliceScene, KeepsItsPlaceUnderTheOptimizer)
{
    const auto make = [] {
        osg::ref_ptr<osg::MatrixTransform> turned = new osg::MatrixTransform(
            osg::Matrixd::rotate(0.4, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(2, 1, 3));
        turned->setDataVariance(osg::Object::STATIC);
        osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
        slice->setPlane(osg::Vec3d(12, 12, 12), osg::Vec3d(0.3, -0.5, 0.8));
        turned->addChild(slicedOnly(voxelsOf(), GREY, slice));
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(turned);
        return root;
    };
    const FloatImage expected = support::renderScene(make(), view());
    EXPECT_GT(support::coveredPixels(expected).count(), 500u);
    for (const unsigned flags : {unsigned(osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS),
                                 unsigned(osgUtil::Optimizer::ALL_OPTIMIZATIONS), (1u << 22) - 1}) {
        const osg::ref_ptr<osg::Group> root = make();
        osgUtil::Optimizer().optimize(root, flags);
        EXPECT_LT(support::compare(support::renderScene(root, view()), expected).maximum, 1e-4)
            << flags;
    }
}

// Coarse first, and then as fine as a pixel; without waiting.
TEST_F(SliceScene, OfPagedVoxelsIsCoarseUntilPagesAreThere)
{
    osg::ref_ptr<paged::FormulaSource> source = new paged::FormulaSource(64, paged::waves);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(0.0, 1.0));
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setPlane(osg::Vec3d(31.5, 31.5, 20.3), osg::Vec3d(0.2, 0.1, 1.0));
    slice->setExactFiltering(true);
    RenderOptions options = RenderOptions().size(160, 140).perspective(40.0).lookAt(
        {31.5, -40, 110}, {31.5, 31.5, 20}, {0, 1, 0});
    source->openFrom(1); // the finest level waits
    const osg::ref_ptr<A> scene = slicedOnly(voxels, GREY, slice);
    support::SceneRenderer renderer(scene, options);
    const FloatImage coarse = paged::renderUntil(renderer, [](const FloatImage& picture) {
        return support::coveredPixels(picture).count() > 1000;
    });
    EXPECT_GT(renderer.counters()["osgVolumizer pages missing"], 0.0);
    source->openFrom(0);
    const FloatImage fine = paged::settle(renderer);
    const core::Plane plane = planeThrough({31.5, 31.5, 20.3}, {0.2, 0.1, 1.0});
    const auto grid = oracle::Grid(glm::ivec3(64), [] {
        std::vector<double> samples;
        for (int z = 0; z < 64; ++z)
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x)
                    samples.push_back(float(paged::waves(glm::dvec3(x, y, z))));
        return samples;
    }());
    const FloatImage expected = pictureOf(
        options, [&](const glm::dvec3& o, const glm::dvec3& d) -> std::optional<glm::dvec4> {
            const glm::dvec3 p = meet(plane, o, d);
            if (!isWithin(p, glm::dvec3(0.0), glm::dvec3(63.0))) return std::nullopt;
            return glm::dvec4(glm::dvec3(grid.value(p)), 1.0);
        });
    EXPECT_LT(differenceOf(fine, expected).maximum, 3e-6);
    EXPECT_GT(differenceOf(fine, expected).pixels, 1000u);
    EXPECT_LT(differenceOf(coarse, expected).maximum, 0.05);
    // Nothing of the lower half was read.
    EXPECT_LE(source->reads[0], 32);
}

// A strip along an arc, flat and in place: the same values.
TEST_F(SliceScene, OfACurvedStripIsTheSameLaidFlat)
{
    std::vector<osg::Vec3d> line;
    for (int i = 0; i <= 24; ++i) {
        const double angle = 0.13 * i;
        line.emplace_back(12.0 - 9.0 * std::cos(angle), 3.0 + 9.0 * std::sin(angle), 8.0 + 0.2 * i);
    }
    const auto strip = makeCurvedStrip(line, osg::Vec3d(0, 0, 3), 6.0);
    ASSERT_TRUE(strip.ok());
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    ASSERT_TRUE(slice->setGeometry(strip->unrolled, 0));
    slice->setExactFiltering(true);
    RenderOptions flat = RenderOptions().size(160, 70).orthographic(7.0).lookAt(
        {0.5 * strip->length, 2.4, 50}, {0.5 * strip->length, 2.4, 0}, {0, 1, 0});
    const FloatImage picture = support::renderScene(slicedOnly(voxelsOf(9), GREY, slice), flat);
    support::savePicture(picture, "slice_curved_flat");
    const auto grid = gridOf(*voxelsOf());
    const double step = strip->length / 24.0;
    const FloatImage expected =
        pictureOf(flat, [&](const glm::dvec3& o, const glm::dvec3&) -> std::optional<glm::dvec4> {
            const double along = o.x / step;
            if (along < 0.0 || along > 24.0) return std::nullopt;
            const auto i = std::min(std::size_t(along), std::size_t(23));
            const osg::Vec3d p = line[i] + (line[i + 1] - line[i]) * (along - double(i));
            const double up = o.y - 0.2 * along;
            if (std::abs(up) > 3.0) return std::nullopt;
            return glm::dvec4(glm::dvec3(grid->value({p.x(), p.y(), p.z() + up})), 1.0);
        });
    EXPECT_GT(differenceOf(picture, expected).pixels, 2000u);
    EXPECT_LT(differenceOf(picture, expected).maximum, 1e-5);
    ASSERT_TRUE(slice->setGeometry(strip->inPlace));
    const FloatImage inPlace =
        support::renderScene(slicedOnly(voxelsOf(9), GREY, slice), view({12, -40, 30}));
    EXPECT_GT(support::coveredPixels(inPlace).count(), 500u);
    support::savePicture(inPlace, "slice_curved");
}

namespace {

// Draws a quad at z = 7 with a program that looks the bricks' values up.
class DrawQuad : public BrickDrawCallback
{
public:
    void drawBrick(osg::RenderInfo& renderInfo, const BoundBrick& brick) const override
    {
        ++bricks;
        osg::State& state = *renderInfo.getState();
        const auto* program = state.getLastAppliedProgramObject();
        if (!program) return;
        osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
        const auto place = [&](const char* name) {
            return program->getUniformLocation(osg::Uniform::getNameID(name));
        };
        const osg::Matrixf toTexture(brick.objectToTexture);
        gl.glUniformMatrix4fv(place("objectToTexture"), 1, GL_FALSE, toTexture.ptr());
        const osg::Vec3f low(brick.boxObject._min), high(brick.boxObject._max);
        gl.glUniform3fv(place("boxMin"), 1, low.ptr());
        gl.glUniform3fv(place("boxMax"), 1, high.ptr());
        gl.glUniform1i(place("voxels"), int(brick.textureUnit));
        gl.glUniform2f(place("fraction"), float(brick.fractionScale), float(brick.fractionOffset));
        quad->drawImplementation(renderInfo);
    }
    unsigned textureUnit() const override { return 3; }

    mutable int bricks = 0;
    osg::ref_ptr<osg::Geometry> quad = support::makeQuad({}, osg::Vec4(1, 1, 1, 1), false);
};

} // namespace

TEST_F(SliceScene, HandsTexturesOfBricksToApplications)
{
    osg::ref_ptr<DrawQuad> draw = new DrawQuad;
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec3& corner : {osg::Vec3(2, 3, 7), {21, 3, 7}, {21, 22, 7}, {2, 22, 7}})
        corners->push_back(corner);
    draw->quad->setVertexArray(corners);
    draw->quad->setUseDisplayList(false);
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setPolygon({{2, 3, 7}, {21, 3, 7}, {21, 22, 7}, {2, 22, 7}});
    const FloatImage own = support::renderScene(slicedOnly(voxelsOf(9), GREY, slice), view());
    slice->setBrickDrawCallback(draw);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                       "#version 120\nvarying vec3 place;\nvoid main() { place = "
                                       "gl_Vertex.xyz; gl_Position = ftransform(); }\n"));
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT,
        "#version 120\nvarying vec3 place;\nuniform mat4 objectToTexture;\n"
        "uniform vec3 boxMin, boxMax;\nuniform vec2 fraction;\nuniform sampler3D voxels;\n"
        "void main() {\n    if (any(lessThan(place, boxMin)) || any(greaterThanEqual(place, "
        "boxMax))) discard;\n    float v = texture3D(voxels, (objectToTexture * vec4(place, "
        "1.0)).xyz).r * fraction.x + fraction.y;\n    gl_FragColor = vec4(v, v, v, 1.0);\n}\n"));
    slice->getOrCreateStateSet()->setAttributeAndModes(program);
    const FloatImage drawn = support::renderScene(slicedOnly(voxelsOf(9), GREY, slice), view());
    EXPECT_EQ(draw->bricks, 9);
    const SliceDifference difference = differenceOf(own, drawn);
    EXPECT_GT(difference.pixels, 500u);
    EXPECT_LT(difference.maximum, 1e-4);
    EXPECT_LE(difference.edge, 20u);
}

TEST_F(SliceScene, RefusesWhatIsNoSurface)
{
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setName("cut");
    ASSERT_TRUE(slice->setPlane(osg::Vec4d(0, 0, 2, -14)));
    const double nan = std::nan(""), infinite = INFINITY;
    support::Reports reports;
    EXPECT_EQ(slice->setPlane(osg::Vec4d(0, 0, 0, 1)).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPlane(osg::Vec4d(0, nan, 1, 1)).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPlane(osg::Vec3d(0, infinite, 1), osg::Vec3d(1, 0, 0)).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPlane(osg::Vec3d(), osg::Vec3d()).code, ErrorCode::VALUE_INVALID);
    // An hourglass, one that touches itself, one that folds back, one that is not planar, too few.
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {4, 4, 0}, {5, 0, 0}, {0, 4, 0}}).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {8, 0, 0}, {8, 5, 0}, {4, 0, 0}, {0, 5, 0}}).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {8, 0, 0}, {5, 0, 0}, {5, 5, 0}}).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {8, 0, 0}, {8, 8, 1}, {0, 8, 0}}).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {8, 0, 0}}).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setPolygon({{0, 0, 0}, {8, 0, 0}, {8, nan, 0}}).code,
              ErrorCode::VALUE_INVALID);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    EXPECT_EQ(slice->setGeometry(nullptr).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(slice->setGeometry(geometry).code, ErrorCode::VALUE_INVALID);
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array(3);
    geometry->setVertexArray(points);
    EXPECT_EQ(slice->setGeometry(geometry).code, ErrorCode::VALUE_INVALID);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    EXPECT_EQ(slice->setGeometry(geometry, 0).code, ErrorCode::VALUE_INVALID);
    (*points)[1].y() = float(infinite);
    EXPECT_EQ(slice->setGeometry(geometry).code, ErrorCode::VALUE_INVALID);
    for (const double bad : {nan, infinite, -1.0}) {
        EXPECT_FALSE(slice->setThickness(bad));
        EXPECT_FALSE(slice->setOpacity(bad));
        EXPECT_FALSE(slice->setSamplingPeriod(bad));
        if (bad != -1.0) {
            EXPECT_FALSE(slice->setWindow(bad, 1.0));
            EXPECT_FALSE(slice->setWindow(1.0, bad));
        }
    }
    EXPECT_EQ(reports.all(), std::size_t(reports.count("VolumeSlice \"cut\": ")));
    EXPECT_EQ(reports.all(), 15u + 3u * 3u + 4u);
    EXPECT_EQ(slice->getShape(), VolumeSlice::PLANE);
    EXPECT_EQ(slice->getPlane(), osg::Vec4d(0, 0, 1, -7));
    EXPECT_EQ(slice->getOpacity(), 1.0);
    EXPECT_EQ(makeCurvedStrip({{0, 0, 0}}, {0, 0, 1}, 1.0).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_FALSE(makeCurvedStrip({{0, 0, 0}, {0, 0, 3}}, {0, 0, 1}, 1.0).ok());
    EXPECT_FALSE(makeCurvedStrip({{0, 0, 0}, {0, nan, 3}}, {0, 0, 1}, 1.0).ok());
}

} // namespace SliceSceneTest
