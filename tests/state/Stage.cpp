#include "Stage.h"

#include <render/Volumes.h>
#include <support/Shapes.h>

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/MatrixTransform>
#include <osg/Stencil>
#include <osg/Texture2D>

#include <cmath>

namespace osgVolumizer {
namespace test {

namespace {

using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

// Edges of all that is drawn lie between pixel centres.
// What is under the state has no symmetry up and down.
constexpr float WIDTH = 24.0f, DEPTH = 16.0f, UP = 2.0f;

/// A rectangle that faces the eye, with all that fixed function can ask for.
osg::ref_ptr<osg::Geometry> rectangle(const osg::Vec2& low, const osg::Vec2& high, float z,
                                      const osg::Vec4& color, bool translucent = false)
{
    const osg::ref_ptr<osg::Geometry> quad =
        support::makeQuad({osg::Vec3(low.x(), low.y(), z), {high.x(), low.y(), z},
                           {high.x(), high.y(), z}, {low.x(), high.y(), z}},
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

osg::ref_ptr<osg::Geometry> layer(float halfWidth, float z, const osg::Vec4& color)
{
    return rectangle({-halfWidth, UP - halfWidth}, {halfWidth, UP + halfWidth}, z, color, true);
}

osg::ref_ptr<osg::Node> box(VolumeAppearance::RayFunction function,
                               VolumeAppearance::Technique technique, const glm::dvec4& color,
                               float z)
{
    // Values that are none of [0, 1], in a range that is not: what is gathered must not be clamped.
    const auto voxels =
        makeVoxels(glm::ivec3(int(WIDTH) + 1, int(WIDTH) + 1, int(DEPTH) + 1),
                   [](const glm::dvec3&) { return 30.0; });
    voxels->setRange(osg::Vec2d(0.0, 40.0));
    const osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setRayFunction(function);
    appearance->setTechnique(technique);
    appearance->setLookupTable(makeTable({{0.0, {0.0, 0.0, 0.0, 0.0}}, {0.75, color}, {1.0, color}}));
    osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(
        osg::Matrix::translate(-0.5 * WIDTH, UP - 0.5 * WIDTH, z - 0.5 * DEPTH));
    placed->addChild(appearance);
    return placed;
}

RenderOptions view(Target target)
{
    RenderOptions options;
    options.size(Stage::SIZE, Stage::SIZE);
    options.projection = osg::Matrixd::ortho(-24, 24, -24, 24, 1.0, 201.0);
    options.lookAt({0, 0, 100}, {0, 0, 0}, {0, 1, 0});
    options.format = target == Target::ANY ? PictureTarget::FLOAT32_STENCIL : PictureTarget::BYTE;
    options.background = osg::Vec4(0.1f, 0.1f, 0.2f, 0.5f);
    options.depth = target != Target::SAMPLES; // whose depth has no texture
    options.computeNearFar = false;
    return options;
}

osg::Vec4 surfaceColor()
{
    return osg::Vec4(0.2f, 0.9f, 0.3f, 0.4f);
}

} // namespace

struct Stage::Version
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Group> volumes = new osg::Group;  ///< below the state, if it concerns them
    osg::ref_ptr<osg::Group> surfaces = new osg::Group; ///< likewise
    std::unique_ptr<support::SceneRenderer> renderer;

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

Stage::Stage(Content content, Target target)
    : _content(content), _target(target), _volume(new Version), _geometry(new Version)
{
    // What the volume itself looks like: premultiplied, over nothing.
    RenderOptions options = view(Target::ANY);
    options.background = osg::Vec4();
    const FloatImage alone = support::renderScene(volumes(), options);
    const glm::vec4 seen = alone.empty() ? glm::vec4(1.0f) : alone.at(SIZE / 2, SIZE / 2);
    _color = osg::Vec4(seen.r / seen.a, seen.g / seen.a, seen.b / seen.a, seen.a);
    _volume->volumes->addChild(volumes());
    makeMeshes();
}

Stage::~Stage() = default;

osg::ref_ptr<osg::Group> Stage::volumes() const
{
    const glm::dvec4 yellow(0.9, 0.8, 0.2, 0.05), violet(0.5, 0.2, 0.9, 0.07);
    const auto technique =
        _content == Content::SLICES ? VolumeAppearance::SLICES : VolumeAppearance::SLABS;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    if (_content == Content::MAXIMUM)
        group->addChild(box(VolumeAppearance::MAXIMUM, technique, {0.9, 0.8, 0.2, 0.6}, 0.0f));
    else
        group->addChild(box(VolumeAppearance::COMPOSITE, technique, yellow, 0.0f));
    if (_content == Content::OVERLAP)
        group->addChild(box(VolumeAppearance::COMPOSITE, technique, violet, 6.0f));
    return group;
}

void Stage::makeMeshes()
{
    const float half = 0.5f * WIDTH;
    if (_content != Content::SURFACE && _content != Content::BARE_SURFACE) {
        _geometry->volumes->addChild(layer(half, 0.0f, _color));
        return;
    }
    for (Version* version : {_volume.get(), _geometry.get()})
        version->surfaces->addChild(layer(8.0f, 0.0f, surfaceColor()));
    const float alpha = 1.0f - std::sqrt(1.0f - _color.a());
    for (float z : {-4.0f, 4.0f})
        _geometry->volumes->addChild(
            layer(half, z, osg::Vec4(_color.r(), _color.g(), _color.b(), alpha)));
}

Stage::Shown Stage::show(std::unique_ptr<Version>& version)
{
    if (!version->renderer) {
        version->renderer =
            std::make_unique<support::SceneRenderer>(version->root, view(_target));
        if (_target == Target::SAMPLES) // before the first frame makes the framebuffer
            for (auto& attachment : version->renderer->viewer().getCamera()->getBufferAttachmentMap())
                attachment.second._multisampleSamples = 4;
    }
    Shown shown;
    shown.picture = version->renderer->render();
    shown.glError = version->renderer->glError();
    // It is remembered.
    if (shown.glError) version->renderer.reset();
    return shown;
}

Stage::Shown Stage::volume(const StateRow* row, unsigned value)
{
    osg::ref_ptr<osg::StateSet> set;
    if (row) row->set(*(set = new osg::StateSet), value);
    _volume->volumes->setStateSet(set);
    _volume->surfaces->setStateSet(_content == Content::SURFACE ? set.get() : nullptr);
    return show(_volume);
}

Stage::Shown Stage::geometry(const StateRow* row, unsigned value, bool concernsVolumes)
{
    osg::ref_ptr<osg::StateSet> set;
    if (row) row->set(*(set = new osg::StateSet), value);
    _geometry->volumes->setStateSet(concernsVolumes ? set.get() : nullptr);
    _geometry->surfaces->setStateSet(_content == Content::SURFACE ? set.get() : nullptr);
    return show(_geometry);
}

void Stage::restart()
{
    _volume->renderer.reset();
    _geometry->renderer.reset();
}

} // namespace test
} // namespace osgVolumizer
