#include "Renderer.h"

#include <osg/BlendFunc>
#include <osg/TransferFunction>
#include <osgVolume/FixedFunctionTechnique>
#include <osgVolume/Layer>
#include <osgVolume/Locator>
#include <osgVolume/MultipassTechnique>
#include <osgVolume/Property>
#include <osgVolume/RayTracedTechnique>
#include <osgVolume/VolumeScene>
#include <osgVolume/VolumeTile>

#include <algorithm>
#include <cmath>
#include <cstring>

#ifndef GL_INTENSITY16
#define GL_INTENSITY16 0x804D
#endif
#ifndef GL_INTENSITY8
#define GL_INTENSITY8 0x804B
#endif
#ifndef GL_INTENSITY32F_ARB
#define GL_INTENSITY32F_ARB 0x8817
#endif

namespace osgVolumizer {
namespace bench {

namespace {

constexpr int TABLE_SIZE = 4096;

osg::Matrixd boxMatrix(const glm::dvec3& low, const glm::dvec3& high)
{
    const glm::dvec3 size = high - low;
    return osg::Matrixd::scale(size.x, size.y, size.z) *
           osg::Matrixd::translate(low.x, low.y, low.z);
}

/// osgVolume with what makes it most accurate: tables of 32-bit floats, the alpha of one step in
/// the table (the techniques know no opacity unit, or one that holds for steps below a voxel only),
/// no alpha test, the blend function that its shaders' output asks for, no lighting, voxels in
/// their own precision. Not corrected: the techniques' own quadrature.
class OsgVolumeRenderer : public Renderer
{
public:
    explicit OsgVolumeRenderer(OsgVolumeTechnique technique) : _technique(technique) {}

    std::string name() const override
    {
        return _technique == OsgVolumeTechnique::FIXED_FUNCTION ? "osgVolume FixedFunction"
               : _technique == OsgVolumeTechnique::RAY_TRACED   ? "osgVolume RayTraced"
                                                                : "osgVolume Multipass";
    }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override;
    void frame() override { _renderer->viewer().frame(); }
    support::FloatImage picture() override;

private:
    bool fixedFunction() const { return _technique == OsgVolumeTechnique::FIXED_FUNCTION; }
    osg::ref_ptr<osg::Image> voxelImage() const;
    osg::ref_ptr<osg::Image> classifiedImage(double stepVoxel) const;
    osg::ref_ptr<osg::TransferFunction1D> transferFunction(double stepVoxel) const;
    glm::dvec4 colorOfStep(double fraction, double stepVoxel) const;
    osg::ref_ptr<osgVolume::Property> properties(double stepVoxel) const;
    osg::ref_ptr<osgVolume::VolumeTechnique> makeTechnique(double stepVoxel) const;
    osg::ref_ptr<osg::Node> makeNode(double stepVoxel);

    OsgVolumeTechnique _technique;
    ChartScene _scene;
    core::TransferFunction _function;
    osg::ref_ptr<osg::Image> _voxels;
    osg::ref_ptr<osg::Group> _root;
    std::unique_ptr<support::SceneRenderer> _renderer;
    int _side = 0; ///< samples along each axis of the image
};

Status OsgVolumeRenderer::open(const ChartScene& scene)
{
    if (scene.shaded && fixedFunction()) return Status(ErrorCode::NOT_SUPPORTED, "has no shading");
    if (_technique == OsgVolumeTechnique::RAY_TRACED && scene.view.projection(3, 3) != 0.0)
        return Status(
            ErrorCode::NOT_SUPPORTED,
            "casts perspective rays in orthographic views: its rays all start at the eye");
    _scene = scene;
    const auto function = core::TransferFunction::create(scene.table);
    if (!function.ok()) return function.status;
    _function = *function;
    // The shaders measure lengths in texture coordinates, which only a cube makes isotropic.
    _side = std::max({scene.size.x, scene.size.y, scene.size.z});
    if (!fixedFunction()) _voxels = voxelImage();
    _root = new osg::Group;
    osg::StateSet* state = _root->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    // The ray shaders write premultiplied colours.
    if (!fixedFunction())
        state->setAttributeAndModes(
            new osg::BlendFunc(osg::BlendFunc::ONE, osg::BlendFunc::ONE_MINUS_SRC_ALPHA),
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    support::RenderOptions options = scene.view;
    options.light = scene.shaded;
    _renderer = std::make_unique<support::SceneRenderer>(_root, options);
    return _renderer->status();
}

// The voxels in the corner of a cube.
osg::ref_ptr<osg::Image> OsgVolumeRenderer::voxelImage() const
{
    const bool bytes = _scene.type == VoxelType::UINT8, shorts = _scene.type == VoxelType::UINT16;
    const GLenum type = bytes ? GL_UNSIGNED_BYTE : shorts ? GL_UNSIGNED_SHORT : GL_FLOAT;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(_side, _side, _side, GL_RED, type, 1);
    image->setInternalTextureFormat(bytes    ? GL_INTENSITY8
                                    : shorts ? GL_INTENSITY16
                                             : GL_INTENSITY32F_ARB);
    std::memset(image->data(), 0, image->getTotalSizeInBytes());
    const glm::ivec3 n = _scene.size;
    const std::size_t row = std::size_t(n.x) * voxelTypeSize(_scene.type);
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            std::memcpy(image->data(0, y, z),
                        _scene.voxels.data() + (std::size_t(z) * n.y + std::size_t(y)) * row, row);
    return image;
}

// Straight colour, opacity of one step.
glm::dvec4 OsgVolumeRenderer::colorOfStep(double fraction, double stepVoxel) const
{
    glm::dvec4 c = _function.evaluate(fraction);
    c.a = core::opacityFromExtinction(core::extinctionFromOpacity(c.a), stepVoxel);
    return c;
}

// FixedFunction knows no table: colours are looked up before interpolation, which is 'nearest'.
osg::ref_ptr<osg::Image> OsgVolumeRenderer::classifiedImage(double stepVoxel) const
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    const glm::ivec3 n = _scene.size;
    image->allocateImage(n.x, n.y, n.z, GL_RGBA, GL_FLOAT, 1);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    float* out = reinterpret_cast<float*>(image->data());
    for (double value : _scene.values()) {
        const double fraction = (value - _scene.range.x) / (_scene.range.y - _scene.range.x);
        const glm::vec4 c(colorOfStep(fraction, stepVoxel));
        for (int k = 0; k < 4; ++k)
            *out++ = c[k];
    }
    return image;
}

osg::ref_ptr<osg::TransferFunction1D> OsgVolumeRenderer::transferFunction(double stepVoxel) const
{
    osg::ref_ptr<osg::TransferFunction1D> tf = new osg::TransferFunction1D;
    tf->allocate(TABLE_SIZE);
    // Ends of the domain such that entry i lies at i/(n-1) of the range.
    osg::TransferFunction1D::ColorMap ends;
    ends[float(-0.5 / (TABLE_SIZE - 1))] = osg::Vec4();
    ends[float(1.0 + 0.5 / (TABLE_SIZE - 1))] = osg::Vec4();
    tf->setColorMap(ends);
    osg::Image* image = tf->getImage();
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    float* out = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < TABLE_SIZE; ++i) {
        const glm::vec4 c(colorOfStep(i / (TABLE_SIZE - 1.0), stepVoxel));
        for (int k = 0; k < 4; ++k)
            *out++ = c[k];
    }
    return tf;
}

osg::ref_ptr<osgVolume::Property> OsgVolumeRenderer::properties(double stepVoxel) const
{
    osg::ref_ptr<osgVolume::CompositeProperty> all = new osgVolume::CompositeProperty;
    all->addProperty(new osgVolume::AlphaFuncProperty(0.0f));
    if (fixedFunction()) return all;
    all->addProperty(new osgVolume::TransparencyProperty(1.0f));
    if (_scene.shaded) all->addProperty(new osgVolume::LightingProperty);
    double tableStep = stepVoxel;
    if (_technique == OsgVolumeTechnique::MULTIPASS) {
        // Corrects the opacity itself for steps below one voxel, and not above.
        tableStep = std::max(1.0, stepVoxel);
        all->addProperty(new osgVolume::SampleRatioProperty(float(1.0 / stepVoxel)));
    } else {
        all->addProperty(new osgVolume::SampleDensityProperty(float(stepVoxel / _side)));
    }
    all->addProperty(new osgVolume::TransferFunctionProperty(transferFunction(tableStep)));
    return all;
}

osg::ref_ptr<osgVolume::VolumeTechnique> OsgVolumeRenderer::makeTechnique(double stepVoxel) const
{
    if (_technique == OsgVolumeTechnique::RAY_TRACED) return new osgVolume::RayTracedTechnique;
    if (_technique == OsgVolumeTechnique::MULTIPASS) return new osgVolume::MultipassTechnique;
    osg::ref_ptr<osgVolume::FixedFunctionTechnique> technique =
        new osgVolume::FixedFunctionTechnique;
    const double diagonal = glm::length(glm::dvec3(_scene.size));
    technique->setNumSlices(unsigned(std::lround(diagonal / stepVoxel)) + 1u);
    return technique;
}

osg::ref_ptr<osg::Node> OsgVolumeRenderer::makeNode(double stepVoxel)
{
    const glm::dvec3 texels = fixedFunction() ? glm::dvec3(_scene.size) : glm::dvec3(_side);
    osg::ref_ptr<osgVolume::ImageLayer> layer = new osgVolume::ImageLayer(
        fixedFunction() ? classifiedImage(stepVoxel).get() : _voxels.get());
    // Images span whole texels, the volume the samples at their centres.
    osg::ref_ptr<osgVolume::Locator> imageBox =
        new osgVolume::Locator(boxMatrix(_scene.origin - 0.5, _scene.origin + texels - 0.5));
    osg::ref_ptr<osgVolume::Locator> sampleBox =
        new osgVolume::Locator(boxMatrix(_scene.boxMin(), _scene.boxMax()));
    layer->setLocator(imageBox);
    layer->addProperty(properties(stepVoxel));
    osg::ref_ptr<osgVolume::VolumeTile> tile = new osgVolume::VolumeTile;
    tile->setLocator(fixedFunction() ? imageBox.get() : sampleBox.get());
    tile->setLayer(layer);
    tile->setVolumeTechnique(makeTechnique(stepVoxel));
    if (_technique != OsgVolumeTechnique::MULTIPASS) return tile;
    osg::ref_ptr<osgVolume::VolumeScene> scene = new osgVolume::VolumeScene;
    scene->addChild(tile);
    return scene;
}

Status OsgVolumeRenderer::setStep(double stepVoxel)
{
    _root->removeChildren(0, _root->getNumChildren());
    _root->addChild(makeNode(stepVoxel));
    return {};
}

support::FloatImage OsgVolumeRenderer::picture()
{
    support::FloatImage image = _renderer->render();
    if (_technique != OsgVolumeTechnique::MULTIPASS) return image;
    // The last shader multiplies what is premultiplied by alpha once more. Taken back here, so that
    // the chart shows its sampling.
    for (glm::vec4& p : image.pixels) {
        const float alpha = std::sqrt(std::max(p.a, 0.0f));
        p = alpha > 0.0f ? p / alpha : glm::vec4(0.0f);
    }
    return image;
}

} // namespace

RendererPtr makeOsgVolumeRenderer(OsgVolumeTechnique technique)
{
    return std::make_unique<OsgVolumeRenderer>(technique);
}

} // namespace bench
} // namespace osgVolumizer
