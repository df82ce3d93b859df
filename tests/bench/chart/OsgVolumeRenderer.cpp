#include "MixedScene.h"
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

constexpr int COLOR_TABLE_SIZE = 4096;

osg::Matrixd boxMatrix(const glm::dvec3& low, const glm::dvec3& high)
{
    const glm::dvec3 size = high - low;
    return osg::Matrixd::scale(size.x, size.y, size.z) *
           osg::Matrixd::translate(low.x, low.y, low.z);
}

/// One volume of a scene as a tile: see OsgVolumeRenderer.
class Tile
{
public:
    Tile(const ChartVolume& volume, OsgVolumeTechnique technique, bool shaded)
        : _volume(volume), _technique(technique), _shaded(shaded),
          // The shaders measure lengths in texture coordinates, which only a cube makes isotropic.
          _side(std::max({volume.size.x, volume.size.y, volume.size.z}))
    {
    }

    Status open();
    osg::ref_ptr<osg::Node> makeNode(double stepVoxel) const;

private:
    bool fixedFunction() const { return _technique == OsgVolumeTechnique::FIXED_FUNCTION; }
    osg::ref_ptr<osg::Image> voxelImage() const;
    osg::ref_ptr<osg::Image> classifiedImage(double stepVoxel) const;
    osg::ref_ptr<osg::TransferFunction1D> transferFunction(double stepVoxel) const;
    glm::dvec4 colorOfStep(double fraction, double stepVoxel) const;
    osg::ref_ptr<osgVolume::Property> properties(double stepVoxel) const;
    osg::ref_ptr<osgVolume::VolumeTechnique> makeTechnique(double stepVoxel) const;

    ChartVolume _volume;
    OsgVolumeTechnique _technique;
    bool _shaded;
    int _side; ///< samples along each axis of the image
    core::TransferFunction _function;
    osg::ref_ptr<osg::Image> _voxels;
};

Status Tile::open()
{
    const auto function = core::TransferFunction::create(_volume.table);
    if (!function.ok()) return function.status;
    _function = *function;
    if (!fixedFunction()) _voxels = voxelImage();
    return {};
}

// The voxels in the corner of a cube.
osg::ref_ptr<osg::Image> Tile::voxelImage() const
{
    const bool bytes = _volume.type == VoxelType::UINT8, shorts = _volume.type == VoxelType::UINT16;
    const GLenum type = bytes ? GL_UNSIGNED_BYTE : shorts ? GL_UNSIGNED_SHORT : GL_FLOAT;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(_side, _side, _side, GL_RED, type, 1);
    image->setInternalTextureFormat(bytes    ? GL_INTENSITY8
                                    : shorts ? GL_INTENSITY16
                                             : GL_INTENSITY32F_ARB);
    std::memset(image->data(), 0, image->getTotalSizeInBytes());
    const glm::ivec3 n = _volume.size;
    const std::size_t row = std::size_t(n.x) * voxelTypeSize(_volume.type);
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            std::memcpy(image->data(0, y, z),
                        _volume.voxels.data() + (std::size_t(z) * n.y + std::size_t(y)) * row, row);
    return image;
}

// Straight colour, opacity of one step.
glm::dvec4 Tile::colorOfStep(double fraction, double stepVoxel) const
{
    glm::dvec4 c = _function.evaluate(fraction);
    c.a = core::opacityFromExtinction(core::extinctionFromOpacity(c.a), stepVoxel);
    return c;
}

// FixedFunction knows no table: colours are looked up before interpolation, which is 'nearest'.
osg::ref_ptr<osg::Image> Tile::classifiedImage(double stepVoxel) const
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    const glm::ivec3 n = _volume.size;
    image->allocateImage(n.x, n.y, n.z, GL_RGBA, GL_FLOAT, 1);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    float* out = reinterpret_cast<float*>(image->data());
    for (double value : _volume.values()) {
        const double fraction = (value - _volume.range.x) / (_volume.range.y - _volume.range.x);
        const glm::vec4 c(colorOfStep(fraction, stepVoxel));
        for (int k = 0; k < 4; ++k)
            *out++ = c[k];
    }
    return image;
}

osg::ref_ptr<osg::TransferFunction1D> Tile::transferFunction(double stepVoxel) const
{
    osg::ref_ptr<osg::TransferFunction1D> tf = new osg::TransferFunction1D;
    tf->allocate(COLOR_TABLE_SIZE);
    // Ends of the domain such that entry i lies at i/(n-1) of the range.
    osg::TransferFunction1D::ColorMap ends;
    ends[float(-0.5 / (COLOR_TABLE_SIZE - 1))] = osg::Vec4();
    ends[float(1.0 + 0.5 / (COLOR_TABLE_SIZE - 1))] = osg::Vec4();
    tf->setColorMap(ends);
    osg::Image* image = tf->getImage();
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    float* out = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < COLOR_TABLE_SIZE; ++i) {
        const glm::vec4 c(colorOfStep(i / (COLOR_TABLE_SIZE - 1.0), stepVoxel));
        for (int k = 0; k < 4; ++k)
            *out++ = c[k];
    }
    return tf;
}

osg::ref_ptr<osgVolume::Property> Tile::properties(double stepVoxel) const
{
    osg::ref_ptr<osgVolume::CompositeProperty> all = new osgVolume::CompositeProperty;
    all->addProperty(new osgVolume::AlphaFuncProperty(0.0f));
    if (fixedFunction()) return all;
    all->addProperty(new osgVolume::TransparencyProperty(1.0f));
    if (_shaded) all->addProperty(new osgVolume::LightingProperty);
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

osg::ref_ptr<osgVolume::VolumeTechnique> Tile::makeTechnique(double stepVoxel) const
{
    if (_technique == OsgVolumeTechnique::RAY_TRACED) return new osgVolume::RayTracedTechnique;
    if (_technique == OsgVolumeTechnique::MULTIPASS) return new osgVolume::MultipassTechnique;
    osg::ref_ptr<osgVolume::FixedFunctionTechnique> technique =
        new osgVolume::FixedFunctionTechnique;
    const double diagonal = glm::length(glm::dvec3(_volume.size));
    technique->setNumSlices(unsigned(std::lround(diagonal / stepVoxel)) + 1u);
    return technique;
}

osg::ref_ptr<osg::Node> Tile::makeNode(double stepVoxel) const
{
    const glm::dvec3 texels = fixedFunction() ? glm::dvec3(_volume.size) : glm::dvec3(_side);
    osg::ref_ptr<osgVolume::ImageLayer> layer = new osgVolume::ImageLayer(
        fixedFunction() ? classifiedImage(stepVoxel).get() : _voxels.get());
    // Images span whole texels, the volume the samples at their centres.
    osg::ref_ptr<osgVolume::Locator> imageBox =
        new osgVolume::Locator(boxMatrix(_volume.origin - 0.5, _volume.origin + texels - 0.5));
    osg::ref_ptr<osgVolume::Locator> sampleBox =
        new osgVolume::Locator(boxMatrix(_volume.boxMin(), _volume.boxMax()));
    layer->setLocator(imageBox);
    layer->addProperty(properties(stepVoxel));
    osg::ref_ptr<osgVolume::VolumeTile> tile = new osgVolume::VolumeTile;
    tile->setLocator(fixedFunction() ? imageBox.get() : sampleBox.get());
    tile->setLayer(layer);
    tile->setVolumeTechnique(makeTechnique(stepVoxel));
    return tile;
}

/// osgVolume with what makes it most accurate: tables of 32-bit floats, the alpha of one step in
/// the table (the techniques know no opacity unit, or one that holds for steps below a voxel only),
/// no alpha test, the blend function that its shaders' output asks for, no lighting, voxels in
/// their own precision. Not corrected: the techniques' own quadrature, and that volumes and
/// translucent surfaces are drawn one after the other.
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
    Status check(const ChartScene& scene) const;

    OsgVolumeTechnique _technique;
    std::vector<Tile> _tiles;
    osg::ref_ptr<osg::Group> _volumes;
    std::unique_ptr<support::SceneRenderer> _renderer;
};

Status OsgVolumeRenderer::check(const ChartScene& scene) const
{
    const auto refuse = [](const char* why) { return Status(ErrorCode::NOT_SUPPORTED, why); };
    if (scene.shaded && _technique == OsgVolumeTechnique::FIXED_FUNCTION)
        return refuse("has no shading");
    if (_technique == OsgVolumeTechnique::RAY_TRACED && scene.view.projection(3, 3) != 0.0)
        return refuse(
            "casts perspective rays in orthographic views: its rays all start at the eye");
    if (_technique == OsgVolumeTechnique::MULTIPASS && !scene.isOneVolume())
        return refuse("multiplies by alpha twice, which can be taken back for one volume only");
    return {};
}

Status OsgVolumeRenderer::open(const ChartScene& scene)
{
    const Status status = check(scene);
    if (!status.ok()) return status;
    for (const ChartVolume& volume : scene.volumes) {
        _tiles.emplace_back(volume, _technique, scene.shaded);
        const Status opened = _tiles.back().open();
        if (!opened.ok()) return opened;
    }
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    _volumes = new osg::Group;
    root->addChild(_volumes);
    for (const ChartSurface& surface : scene.surfaces)
        root->addChild(test::makeGeometry(surface.mesh, surface.color));
    osg::StateSet* state = _volumes->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    // The ray shaders write premultiplied colours.
    if (_technique != OsgVolumeTechnique::FIXED_FUNCTION)
        state->setAttributeAndModes(
            new osg::BlendFunc(osg::BlendFunc::ONE, osg::BlendFunc::ONE_MINUS_SRC_ALPHA),
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    support::RenderOptions options = scene.view;
    options.light = scene.shaded;
    _renderer = std::make_unique<support::SceneRenderer>(root, options);
    return _renderer->status();
}

Status OsgVolumeRenderer::setStep(double stepVoxel)
{
    // A new VolumeScene too: one remembers tiles that have gone.
    const bool multipass = _technique == OsgVolumeTechnique::MULTIPASS;
    const osg::ref_ptr<osg::Group> scene = multipass ? new osgVolume::VolumeScene : new osg::Group;
    for (const Tile& tile : _tiles)
        scene->addChild(tile.makeNode(stepVoxel));
    _volumes->removeChildren(0, _volumes->getNumChildren());
    _volumes->addChild(scene);
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
