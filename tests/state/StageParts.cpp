#include "StageParts.h"

#include <render/Volumes.h>
#include <support/Shapes.h>

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/MatrixTransform>
#include <osg/Stencil>
#include <osg/Texture2D>

namespace osgVolumizer {
namespace test {

namespace {

// Edges of all that is drawn lie between pixel centres.
constexpr float WIDTH = 24.0f, DEPTH = 16.0f;
// Where one begins, in the world; never a pixel's centre, whatever the viewport.
constexpr float SPLIT_X = -1.0f, SPLIT_Y = UP - 1.0f;

} // namespace

osg::ref_ptr<osg::Geometry> rectangle(const osg::Vec2& low, const osg::Vec2& high, float z,
                                      const osg::Vec4& color, bool translucent)
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

void addLayer(osg::Group& group, float z, const Colors& colors)
{
    const float low = -0.5f * WIDTH, high = 0.5f * WIDTH, bottom = UP + low, top = UP + high;
    group.addChild(rectangle({low, bottom}, {SPLIT_X, SPLIT_Y}, z, colors.corner, true));
    group.addChild(rectangle({SPLIT_X, bottom}, {high, SPLIT_Y}, z, colors.rest, true));
    group.addChild(rectangle({low, SPLIT_Y}, {high, top}, z, colors.rest, true));
}

} // namespace test
} // namespace osgVolumizer
