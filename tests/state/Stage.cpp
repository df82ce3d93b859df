#include "Stage.h"

#include <render/Volumes.h>
#include <support/Compare.h>
#include <support/Shapes.h>

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/MatrixTransform>
#include <osg/Stencil>
#include <osg/Texture2D>

#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace test {

namespace {

using support::FloatImage;
using support::RenderOptions;

// Edges of all that is drawn lie between pixel centres.
// What is under the state has no symmetry up and down.
constexpr float WIDTH = 24.0f, DEPTH = 16.0f, UP = 2.0f;

/// A rectangle that faces the eye, with all that fixed function can ask for.
osg::ref_ptr<osg::Geometry> rectangle(const osg::Vec2& low, const osg::Vec2& high, float z,
                                      const osg::Vec4& color, bool translucent = false)
{
    const osg::ref_ptr<osg::Geometry> quad = support::makeQuad({osg::Vec3(low.x(), low.y(), z),
                                                                {high.x(), low.y(), z},
                                                                {high.x(), high.y(), z},
                                                                {low.x(), high.y(), z}},
                                                               color, translucent);
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(1);
    (*normals)[0] = osg::Vec3(0.0f, 0.0f, 1.0f);
    quad->setNormalArray(normals, osg::Array::BIND_OVERALL);
    osg::ref_ptr<osg::Vec2Array> places = new osg::Vec2Array;
    for (const auto& p : {osg::Vec2(0, 0), osg::Vec2(3, 0), osg::Vec2(3, 2), osg::Vec2(0, 2)})
        places->push_back(p);
    for (unsigned unit = 0; unit < 8; ++unit)
        quad->setTexCoordArray(unit, places);
    quad->setUseDisplayList(false);
    quad->setUseVertexBufferObjects(true);
    quad->setPrimitiveSet(0, new osg::DrawElementsUInt(
                                 GL_TRIANGLES, 6, std::array<GLuint, 6>{0, 1, 2, 0, 2, 3}.data()));
    return quad;
}

osg::ref_ptr<osg::Group> surroundings()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(rectangle({-24, -24}, {0, 24}, -40.0f, {0.2f, 0.3f, 0.4f, 1.0f}));
    group->addChild(rectangle({-16, -16}, {-6, -6}, 30.0f, {0.7f, 0.6f, 0.1f, 1.0f}));
    return group;
}

// Geometry that leaves nothing but the stencil, or needs nothing but it.
osg::ref_ptr<osg::Geometry> stencilWriter()
{
    const auto quad = rectangle({3, -24}, {24, 24}, 0.0f, osg::Vec4(1, 1, 1, 1));
    osg::StateSet* set = quad->getOrCreateStateSet();
    osg::ref_ptr<osg::Stencil> stencil = new osg::Stencil;
    stencil->setFunction(osg::Stencil::ALWAYS, 1, ~0u);
    stencil->setOperation(osg::Stencil::KEEP, osg::Stencil::KEEP, osg::Stencil::REPLACE);
    set->setAttributeAndModes(stencil);
    set->setAttribute(new osg::ColorMask(false, false, false, false));
    set->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false));
    set->setRenderBinDetails(-5, "RenderBin");
    return quad;
}

osg::ref_ptr<osg::Geometry> stencilWitness()
{
    const auto quad = rectangle({-24, -24}, {24, 24}, 0.0f, osg::Vec4(0, 0, 0.125f, 0));
    osg::StateSet* set = quad->getOrCreateStateSet();
    osg::ref_ptr<osg::Stencil> stencil = new osg::Stencil;
    stencil->setFunction(osg::Stencil::EQUAL, 1, ~0u);
    set->setAttributeAndModes(stencil);
    set->setAttributeAndModes(new osg::BlendFunc(osg::BlendFunc::ONE, osg::BlendFunc::ONE));
    set->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false));
    set->setRenderBinDetails(22, "RenderBin");
    return quad;
}

// In OSG's default state, beside the volume and in front of it.
osg::ref_ptr<osg::Group> afterwards()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(90 + i * 29 % 160);
    const auto beside = rectangle({14, 14}, {23, 23}, 10.0f, osg::Vec4(1, 1, 1, 1));
    beside->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    group->addChild(beside);
    group->addChild(rectangle({-4, 5}, {4, 10}, 20.0f, {0.1f, 0.9f, 0.3f, 1.0f}));
    group->addChild(rectangle({-9, -22}, {9, 4}, -20.0f, {0.9f, 0.2f, 0.5f, 0.5f}, true));
    group->getOrCreateStateSet()->setRenderBinDetails(20, "RenderBin",
                                                      osg::StateSet::OVERRIDE_RENDERBIN_DETAILS);
    return group;
}

/// The two colours of a volume: of its lower left part, and of the rest.
struct Colors
{
    osg::Vec4 corner, rest;
};

// Where one begins, in the world; never a pixel's centre, whatever the viewport.
constexpr float SPLIT_X = -1.0f, SPLIT_Y = UP - 1.0f;

osg::ref_ptr<osg::Node> box(VolumeAppearance::RayFunction function,
                            VolumeAppearance::Technique technique, const Colors& colors, float z)
{
    // Values that are none of [0, 1]: what is gathered must not be clamped.
    const auto voxels = makeVoxels(glm::ivec3(13, 13, 9), [](const glm::dvec3& p) {
        return p.x < 5.5 && p.y < 5.5 ? 10.0 : 30.0;
    });
    voxels->setRange(osg::Vec2d(0.0, 40.0));
    voxels->setSpacing(osg::Vec3d(2.0, 2.0, 2.0));
    const osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setRayFunction(function);
    appearance->setTechnique(technique);
    appearance->setInterpolation(VolumeAppearance::NEAREST);
    const auto straight = [](const osg::Vec4& c) { return glm::dvec4(c.r(), c.g(), c.b(), c.a()); };
    const glm::dvec4 corner = straight(colors.corner), rest = straight(colors.rest);
    appearance->setLookupTable(makeTable({{0.0, corner}, {0.4, corner}, {0.6, rest}, {1.0, rest}}));
    osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(
        osg::Matrix::translate(-0.5 * WIDTH, UP - 0.5 * WIDTH, z - 0.5 * DEPTH));
    placed->addChild(appearance);
    return placed;
}

RenderOptions view()
{
    RenderOptions options;
    options.size(Stage::SIZE, Stage::SIZE);
    options.projection = osg::Matrixd::ortho(-24, 24, -24, 24, 1.0, 201.0);
    options.lookAt({0, 0, 100}, {0, 0, 0}, {0, 1, 0});
    options.background = osg::Vec4(0.1f, 0.1f, 0.2f, 0.5f);
    options.computeNearFar = false;
    return options;
}

// What looks like a box, or a layer of it.
void addLayer(osg::Group& group, float z, const Colors& colors)
{
    const float low = -0.5f * WIDTH, high = 0.5f * WIDTH, bottom = UP + low, top = UP + high;
    group.addChild(rectangle({low, bottom}, {SPLIT_X, SPLIT_Y}, z, colors.corner, true));
    group.addChild(rectangle({SPLIT_X, bottom}, {high, SPLIT_Y}, z, colors.rest, true));
    group.addChild(rectangle({low, SPLIT_Y}, {high, top}, z, colors.rest, true));
}

osg::Vec4 straightColor(const FloatImage& premultiplied, int x, int y)
{
    if (premultiplied.empty()) return osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f);
    const glm::vec4 c = premultiplied.at(x, y);
    return osg::Vec4(c.r / c.a, c.g / c.a, c.b / c.a, c.a);
}

// Of half the depth.
osg::Vec4 halved(const osg::Vec4& color)
{
    return osg::Vec4(color.r(), color.g(), color.b(), 1.0f - std::sqrt(1.0f - color.a()));
}

} // namespace

std::string nameOf(Content content)
{
    static const char* const names[] = {"Slabs",   "Slices",      "Maximum",
                                        "Surface", "BareSurface", "Overlap"};
    return names[static_cast<int>(content)];
}

double difference(const FramebufferContents& a, const FramebufferContents& b)
{
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    if (a.empty() || b.empty() || a.stencil != b.stencil) return INFINITE;
    const FloatImage &p = a.colors.front(), &q = b.colors.front();
    support::Mask all{p.width, p.height, {}};
    all.set.assign(p.pixels.size(), 1);
    double largest = support::compare(p, q, all).maximum;
    for (std::size_t i = 0; i < p.depth.size(); ++i)
        largest = std::max(largest, std::abs(double(p.depth[i]) - double(q.depth[i])));
    return largest;
}

struct Stage::Version
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Group> volumes = new osg::Group;  ///< below the state, if it concerns them
    osg::ref_ptr<osg::Group> surfaces = new osg::Group; ///< likewise
    std::unique_ptr<FramebufferRenderer> renderer;

    Version()
    {
        root->addChild(surroundings());
        root->addChild(volumes);
        root->addChild(surfaces);
        root->addChild(afterwards());
        root->addChild(stencilWriter());
        root->addChild(stencilWitness());
        // As usual for translucent geometry; the state in question may differ.
        root->getOrCreateStateSet()->setAttributeAndModes(
            new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
        for (unsigned i : {0u, 3u})
            root->getChild(i)->getOrCreateStateSet()->setAttributeAndModes(
                new osg::Depth(osg::Depth::LESS, 0.0, 1.0, true));
    }
};

Stage::Stage(Content content, const FramebufferFormat& format)
    : _content(content), _format(format), _volume(new Version), _geometry(new Version)
{
    _volume->volumes->addChild(volumes());
    makeMeshes();
}

Stage::~Stage() = default;

osg::ref_ptr<osg::Group> Stage::volumes() const
{
    const float opacity = _content == Content::MAXIMUM   ? 0.6f
                          : _content == Content::OVERLAP ? 0.018f
                                                         : 0.04f;
    const Colors yellow = {{0.9f, 0.8f, 0.2f, opacity}, {0.9f, 0.5f, 0.1f, 0.8f * opacity}};
    const Colors violet = {{0.5f, 0.2f, 0.9f, opacity}, {0.2f, 0.3f, 0.9f, opacity}};
    const auto technique =
        _content == Content::SLICES ? VolumeAppearance::SLICES : VolumeAppearance::SLABS;
    const auto function =
        _content == Content::MAXIMUM ? VolumeAppearance::MAXIMUM : VolumeAppearance::COMPOSITE;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(box(function, technique, yellow, 0.0f));
    if (_content == Content::OVERLAP) group->addChild(box(function, technique, violet, 6.0f));
    return group;
}

void Stage::makeMeshes()
{
    // What the volume itself looks like, over nothing.
    RenderOptions options = view();
    options.background = osg::Vec4();
    const FloatImage alone = support::renderScene(volumes(), options);
    const Colors colors = {straightColor(alone, 15, 17), straightColor(alone, 30, 30)};
    if (_content != Content::SURFACE && _content != Content::BARE_SURFACE) {
        addLayer(*_geometry->volumes, 0.0f, colors);
        return;
    }
    for (Version* version : {_volume.get(), _geometry.get()})
        version->surfaces->addChild(rectangle({-8.0f, UP - 8.0f}, {8.0f, UP + 8.0f}, 0.0f,
                                              osg::Vec4(0.2f, 0.9f, 0.3f, 0.4f), true));
    for (float z : {-4.0f, 4.0f})
        addLayer(*_geometry->volumes, z, {halved(colors.corner), halved(colors.rest)});
}

FramebufferContents Stage::show(Version& version)
{
    if (!version.renderer)
        version.renderer = std::make_unique<FramebufferRenderer>(version.root, view(), _format);
    osg::Camera& camera = version.renderer->camera();
    camera.setViewport(0, 0, SIZE, SIZE);
    camera.setStateSet(new osg::StateSet);
    camera.setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setProjectionMatrix(view().projection);
    if (_arrangement.camera) _arrangement.camera(camera);
    return version.renderer->render();
}

void Stage::setFormat(const FramebufferFormat& format)
{
    _format = format;
    for (Version* version : {_volume.get(), _geometry.get()})
        if (version->renderer) version->renderer->setFormat(format);
}

void Stage::arrange(const Arrangement& arrangement)
{
    _arrangement = arrangement;
    for (Version* version : {_volume.get(), _geometry.get()}) {
        if (!version->renderer) show(*version);
        osg::ref_ptr<osg::Node> scene = version->root;
        if (arrangement.scene) scene = arrangement.scene(scene);
        version->renderer->setScene(scene);
    }
}

FramebufferContents Stage::bare()
{
    for (osg::Group* group : {_geometry->volumes.get(), _geometry->surfaces.get()})
        group->setNodeMask(0);
    const FramebufferContents contents = show(*_geometry);
    for (osg::Group* group : {_geometry->volumes.get(), _geometry->surfaces.get()})
        group->setNodeMask(~0u);
    return contents;
}

FramebufferContents Stage::volume(const StateRow* row, unsigned value)
{
    osg::ref_ptr<osg::StateSet> set;
    if (row) row->set(*(set = new osg::StateSet), value);
    _volume->volumes->setStateSet(set);
    _volume->surfaces->setStateSet(_content == Content::SURFACE ? set.get() : nullptr);
    return show(*_volume);
}

FramebufferContents Stage::geometry(const StateRow* row, unsigned value, bool concernsVolumes)
{
    osg::ref_ptr<osg::StateSet> set;
    if (row) row->set(*(set = new osg::StateSet), value);
    _geometry->volumes->setStateSet(concernsVolumes ? set.get() : nullptr);
    const bool concernsSurfaces = _content == Content::SURFACE && !_surfacesBare;
    _geometry->surfaces->setStateSet(concernsSurfaces ? set.get() : nullptr);
    return show(*_geometry);
}

void Stage::restart()
{
    _volume->renderer.reset();
    _geometry->renderer.reset();
}

} // namespace test
} // namespace osgVolumizer
