#include "Stage.h"

#include "StageParts.h"

#include <support/Compare.h>

#include <osg/ClipNode>
#include <osg/ClipPlane>
#include <osg/Depth>

#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace test {

namespace {

using support::FloatImage;
using support::RenderOptions;

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
        // Planes are of the whole scene; what they cut is below the mode.
        osg::ref_ptr<osg::ClipNode> planes = new osg::ClipNode;
        planes->addClipPlane(new osg::ClipPlane(0, osg::Vec4d(1.0, 0.5, 0.0, 1.0)));
        planes->setStateSetModes(*planes->getOrCreateStateSet(), osg::StateAttribute::OFF);
        root->addChild(planes);
        root->addChild(surroundings());
        root->addChild(volumes);
        root->addChild(surfaces);
        root->addChild(afterwards());
        root->addChild(stencilWriter());
        root->addChild(stencilWitness());
        // As usual for translucent geometry; the state in question may differ.
        root->getOrCreateStateSet()->setAttributeAndModes(
            new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
        for (unsigned i : {1u, 4u})
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
