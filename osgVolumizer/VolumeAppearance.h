#pragma once

#include "LookupTable.h"
#include "Voxels.h"
#include "core/sampling/Polygonize.h"

#include <osg/Group>

#include <memory>

namespace osgVolumizer {
namespace render {
class TableTextures;
}

/// What the volume geometry below is filled with: voxels, lookup table, sampling, shading.
class OSGVOLUMIZER_EXPORT VolumeAppearance : public osg::Group
{
public:
    META_Node(osgVolumizer, VolumeAppearance)

    /// Slabs: exact segments, second order. Slices: one polygon per sampling surface, first order.
    /// AUTOMATIC takes slabs wherever the geometry is convex.
    enum Technique { AUTOMATIC, SLICES, SLABS };
    enum Interpolation { NEAREST, LINEAR };

    VolumeAppearance();
    VolumeAppearance(const VolumeAppearance& o,
                     const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    void setVoxels(Voxels* voxels);
    Voxels* getVoxels() const { return _voxels.get(); }
    /// Never null; setting null restores the default ramp.
    void setLookupTable(LookupTable* table);
    LookupTable* getLookupTable() const { return _lookupTable.get(); }

    void setTechnique(Technique technique) { _technique = technique; }
    Technique getTechnique() const { return _technique; }
    void setInterpolation(Interpolation interpolation) { _interpolation = interpolation; }
    Interpolation getInterpolation() const { return _interpolation; }

    void setSamplingMode(SamplingMode mode) { _sampling.mode = mode; }
    SamplingMode getSamplingMode() const { return _sampling.mode; }
    void setSamplingSpace(SamplingSpace space) { _sampling.space = space; }
    SamplingSpace getSamplingSpace() const { return _sampling.space; }
    /// Distance between samples along the view, in voxels, per voxel axis, each > 0; default 1.
    Status setSamplingPeriod(const osg::Vec3d& periodVoxel);
    osg::Vec3d getSamplingPeriod() const;
    /// Bound on the number of sampling surfaces; >= 1, default 4096.
    Status setMaximumSamples(int count);
    int getMaximumSamples() const { return _sampling.maximumSamples; }
    const core::SamplingParameters& getSamplingParameters() const { return _sampling; }

    /// Thickness, in object units, of the layer that the table's opacity is stated for; 0 (default) takes
    /// the voxels' mean spacing.
    Status setOpacityUnit(double objectUnits);
    double getOpacityUnit() const { return _opacityUnit; }
    /// The unit in force.
    double getEffectiveOpacityUnit() const;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    /// Textures of the lookup table; the renderer's.
    render::TableTextures& tableTextures() const { return *_tableTextures; }

protected:
    ~VolumeAppearance() override;

private:
    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<LookupTable> _lookupTable;
    Technique _technique = AUTOMATIC;
    Interpolation _interpolation = LINEAR;
    core::SamplingParameters _sampling;
    double _opacityUnit = 0.0;
    std::unique_ptr<render::TableTextures> _tableTextures;
};

} // namespace osgVolumizer
