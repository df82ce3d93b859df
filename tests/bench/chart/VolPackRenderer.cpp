#include "Renderer.h"

#include <oracles/Grid.h>
#include <support/OracleView.h>

#include <volpack.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <limits>

namespace osgVolumizer {
namespace bench {

namespace {

constexpr int VALUES = 65536, OPACITIES = 256; // what the two fields of a voxel can hold

// The first field is looked up for colour, the second for opacity.
struct Voxel
{
    std::uint16_t value = 0;
    std::uint8_t opacity = 0;
    std::uint8_t unused = 0;
};

struct DestroyContext
{
    void operator()(vpContext* context) const { vpDestroyContext(context); }
};

void setMatrix(vpContext* context, int which, const glm::dmat4& m)
{
    vpMatrix4 rows;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            rows[row][column] = m[column][row];
    vpCurrentMatrix(context, which);
    vpSetMatrix(context, rows);
}

/// VolPack, the shear-warp renderer, with what makes it most accurate: colours of 16-bit values,
/// preclassified voxels, no ray ended early and no voxel left out, the opacity of each slice such
/// that its own correction for the view is right, and rounded where it would be cut. Slices are a
/// voxel apart, and pixels of the picture before its warp as large as voxels, so that finer steps
/// are those of finer voxels, interpolated before.
///
/// Its error: opacity of 8 bits per voxel, which finer voxels have less of, colours and opacities
/// looked up before interpolation, interpolation within slices and of the picture only, and 8 bits
/// per channel of it. It draws with one thread.
class VolPackRenderer : public Renderer
{
public:
    std::string name() const override { return "VolPack"; }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override;
    void frame() override { vpRenderClassifiedVolume(_context.get()); }
    support::FloatImage picture() override;

private:
    std::vector<Voxel> finerVoxels(const glm::ivec3& size, double step, int viewAxis) const;
    void setVoxels(const glm::ivec3& size, std::vector<Voxel>& voxels);
    void setView(const glm::ivec3& size, double step);
    Status status() const;

    ChartScene _scene;
    std::unique_ptr<oracle::Grid> _fractions; ///< of the table's range
    std::vector<double> _extinctions;         ///< per unit, by value
    std::vector<float> _colors;               ///< red, green, blue by value, to 255
    std::array<float, OPACITIES> _opacities;
    std::unique_ptr<vpContext, DestroyContext> _context;
    std::vector<unsigned char> _image;
};

Status VolPackRenderer::open(const ChartScene& scene)
{
    const auto refuse = [](const char* why) { return Status(ErrorCode::NOT_SUPPORTED, why); };
    if (scene.shaded) return refuse("shades by normals of 8-bit voxels only");
    if (!scene.isOneVolume()) return refuse("draws one volume");
    if (scene.view.projection(3, 3) == 0.0) return refuse("has no perspective views");
    _scene = scene;
    const ChartVolume& volume = _scene.volumes.front();
    std::vector<double> fractions = volume.values();
    for (double& v : fractions)
        v = std::clamp((v - volume.range.x) / (volume.range.y - volume.range.x), 0.0, 1.0);
    _fractions = std::make_unique<oracle::Grid>(volume.size, std::move(fractions));
    const auto function = core::TransferFunction::create(volume.table);
    if (!function.ok()) return function.status;
    for (const glm::vec4& t : function->tabulateExtinction(VALUES, 0.0, 1.0, false)) {
        _extinctions.push_back(t.a);
        for (int c = 0; c < 3; ++c)
            _colors.push_back(255.0f * t[c]);
    }
    // A little more than what is meant, since it is cut to whole 255ths.
    for (int i = 0; i < OPACITIES; ++i)
        _opacities[std::size_t(i)] = i ? float((i + 0.25) / 255.0) : 0.0f;
    _image.resize(std::size_t(scene.view.width) * std::size_t(scene.view.height) * 4);
    return {};
}

// To VolPack, voxels are cells around their samples. Those on the border are half outside of the
// box. What rounding takes from an opacity or adds to it goes to the next voxel along the view, so
// that a ray meets as much as it should.
std::vector<Voxel> VolPackRenderer::finerVoxels(const glm::ivec3& size, double step,
                                                int viewAxis) const
{
    std::vector<std::vector<double>> opacities(4); // in 255ths, by number of borders and value
    for (int borders = 0; borders < 4; ++borders)
        for (const double extinction : _extinctions)
            opacities[std::size_t(borders)].push_back(
                255.0 * core::opacityFromExtinction(extinction, step / (1 << borders)));
    const int u = (viewAxis + 1) % 3, v = (viewAxis + 2) % 3;
    std::vector<double> remainders(std::size_t(size[u]) * std::size_t(size[v]));
    std::vector<Voxel> voxels;
    voxels.reserve(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    glm::ivec3 p;
    for (p.z = 0; p.z < size.z; ++p.z)
        for (p.y = 0; p.y < size.y; ++p.y)
            for (p.x = 0; p.x < size.x; ++p.x) {
                int borders = 0;
                for (int axis = 0; axis < 3; ++axis)
                    borders += p[axis] == 0 || p[axis] == size[axis] - 1;
                Voxel voxel;
                voxel.value = std::uint16_t(
                    std::lround((VALUES - 1) * _fractions->value(step * glm::dvec3(p))));
                double& remainder =
                    remainders[std::size_t(p[u]) + std::size_t(size[u]) * std::size_t(p[v])];
                remainder += opacities[std::size_t(borders)][voxel.value];
                voxel.opacity = std::uint8_t(std::clamp(std::round(remainder), 0.0, 255.0));
                remainder -= voxel.opacity;
                voxels.push_back(voxel);
            }
    return voxels;
}

void VolPackRenderer::setVoxels(const glm::ivec3& size, std::vector<Voxel>& voxels)
{
    vpContext* context = _context.get();
    vpSetVoxelSize(context, sizeof(Voxel), 2, 1, 1);
    vpSetVoxelField(context, 0, sizeof(Voxel::value), offsetof(Voxel, value), VALUES - 1);
    vpSetVoxelField(context, 1, sizeof(Voxel::opacity), offsetof(Voxel, opacity), OPACITIES - 1);
    const int x = sizeof(Voxel), y = x * size.x, z = y * size.y;
    vpSetRawVoxels(context, voxels.data(), z * size.z, x, y, z);
    vpSetClassifierTable(context, 0, 1, _opacities.data(), sizeof(_opacities));
    vpSetLookupShader(context, 3, 1, 0, _colors.data(), int(_colors.size() * sizeof(float)), 0,
                      nullptr, 0);
}

// VolPack's volume is a cube of side 1 around the origin whose low corner is the first sample, and
// its pixels are where their low corners are.
void VolPackRenderer::setView(const glm::ivec3& size, double step)
{
    const glm::dvec3 offset = _scene.volumes.front().origin + 0.5 * step * glm::dvec3(size);
    const double side = step * std::max({size.x, size.y, size.z});
    const glm::dmat4 model(glm::dvec4(side, 0.0, 0.0, 0.0), glm::dvec4(0.0, side, 0.0, 0.0),
                           glm::dvec4(0.0, 0.0, side, 0.0), glm::dvec4(offset, 1.0));
    const support::RenderOptions& view = _scene.view;
    glm::dmat4 projection = support::toGlm(view.projection);
    projection[3][0] -= 1.0 / view.width;
    projection[3][1] -= 1.0 / view.height;
    setMatrix(_context.get(), VP_MODEL, model);
    setMatrix(_context.get(), VP_VIEW, support::toGlm(view.view));
    setMatrix(_context.get(), VP_PROJECT, projection);
    vpSetImage(_context.get(), _image.data(), view.width, view.height, 4 * view.width, VP_RGBA);
}

Status VolPackRenderer::status() const
{
    const vpResult error = vpGetError(_context.get());
    return error == VP_OK ? Status() : Status(ErrorCode::NOT_SUPPORTED, vpGetErrorString(error));
}

Status VolPackRenderer::setStep(double stepVoxel)
{
    if (stepVoxel != 1.0 && stepVoxel != 0.5 && stepVoxel != 0.25)
        return Status(ErrorCode::NOT_SUPPORTED,
                      "is given voxels once, twice and four times as fine, for steps to 0.25");
    const glm::ivec3 size =
        1 + (_scene.volumes.front().size - 1) * int(std::lround(1.0 / stepVoxel));
    const double bytes = double(sizeof(Voxel)) * size.x * size.y * size.z;
    if (bytes > std::numeric_limits<int>::max())
        return Status(ErrorCode::TOO_LARGE, "has no more than 2^31 bytes of voxels");
    _context.reset(vpCreateContext());
    vpContext* context = _context.get();
    vpSetVolumeSize(context, size.x, size.y, size.z);
    setView(size, stepVoxel);
    int axis = VP_NO_AXIS;
    vpGeti(context, VP_VIEW_AXIS, &axis);
    if (axis == VP_NO_AXIS) return status();
    // Runs of voxels along the other two axes would not be drawn.
    vpEnable(context, VP_VIEW_X_AXIS, axis == VP_X_AXIS);
    vpEnable(context, VP_VIEW_Y_AXIS, axis == VP_Y_AXIS);
    vpEnable(context, VP_VIEW_Z_AXIS, axis == VP_Z_AXIS);
    std::vector<Voxel> voxels = finerVoxels(size, stepVoxel, axis);
    setVoxels(size, voxels);
    vpClassifyVolume(context);
    vpSetRawVoxels(context, nullptr, 0, 0, 0, 0);
    return status();
}

support::FloatImage VolPackRenderer::picture()
{
    if (!status().ok()) std::cerr << name() << ": " << status().text << "\n";
    support::FloatImage image(_scene.view.width, _scene.view.height);
    const unsigned char* in = _image.data();
    // Cut to bytes, not rounded.
    for (glm::vec4& p : image.pixels)
        for (int c = 0; c < 4; ++c, ++in)
            p[c] = *in ? (float(*in) + 0.5f) / 255.0f : 0.0f;
    return image;
}

} // namespace

RendererPtr makeVolPackRenderer()
{
    return std::make_unique<VolPackRenderer>();
}

} // namespace bench
} // namespace osgVolumizer
