#pragma once

#include "Error.h"
#include "LookupTable.h"
#include "RenderData.h"
#include "Voxels.h"
#include "core/sampling/Polygonize.h"

#include <osg/Group>

#include <string>
#include <vector>

namespace osgVolumizer {

class VolumeCut;
class VolumeGeometry;

/// Fills the volume geometry below it: voxels, lookup table, sampling, shading.
class OSGVOLUMIZER_EXPORT VolumeAppearance : public osg::Group
{
public:
    /// Slabs: exact segments of rays, second order. Slices: one polygon per sampling surface, first
    /// order. AUTOMATIC takes slabs wherever neither sampling mode nor space asks for slices, but
    /// not of deformed voxels that do not fit into one texture.
    enum Technique
    {
        AUTOMATIC,
        SLICES,
        SLABS
    };
    /// How values between samples are interpolated. NEAREST: the value of the nearest sample.
    /// LINEAR: trilinear. CUBIC: passes through the samples like LINEAR, with continuous
    /// derivatives and third-order accuracy, and may overshoot (Keys, "Cubic convolution
    /// interpolation for digital image processing", IEEE ASSP 29, 1981); 64 samples each, so slow;
    /// bricks need overlap 3.
    enum Interpolation
    {
        NEAREST,
        LINEAR,
        CUBIC
    };
    /// Selects whether values are interpolated first or looked up first.
    enum Lookup
    {
        /// PREINTEGRATED for tables with jumps or peaks that sampling would miss, else
        /// AFTER_INTERPOLATION. The reason is sent to osg::notify(osg::INFO).
        AUTOMATIC_LOOKUP,
        /// Values are interpolated, then looked up: sharp, second order for smooth tables.
        AFTER_INTERPOLATION,
        /// Samples are looked up; extinction, and colour weighted by extinction, are interpolated.
        /// For values that are labels, between which there is nothing. Eight lookups a sample (64
        /// for CUBIC), but still no upload when the table changes.
        BEFORE_INTERPOLATION,
        /// Between two samples the value is taken to run linearly, and the table is averaged over
        /// that run exactly: no value is skipped, however sharp the table (Engel, Kraus and Ertl,
        /// Graphics Hardware 2001, by integral functions).
        PREINTEGRATED,
        /// Rays are split at faces of cells between samples, and where their value turns round or
        /// passes a corner of the table; pieces are integrated to fourth order, whatever the table.
        /// They are no longer than the period. Two to three times the time of a period of a voxel,
        /// at an error that is a tenth to a thousandth (Weiss and Westermann, "Analytic ray
        /// splitting for controlled precision DVR", 2021).
        /// Of slabs, and one component that is not interpolated cubically; else
        /// AFTER_INTERPOLATION.
        CELL_BY_CELL
    };

    /// Selects what a pixel shows of the values on its ray, within the volume and in front of
    /// opaque geometry.
    enum RayFunction
    {
        /// Light emitted and absorbed along the ray. All other functions draw the volume as one
        /// layer, in depth order by its centre.
        COMPOSITE,
        /// The highest value, which is then looked up: colour, and opacity as for a layer one unit
        /// thick. Of RGBA voxels: of each premultiplied component.
        MAXIMUM,
        /// The lowest value, likewise.
        MINIMUM,
        /// The mean value over the length of the ray, then looked up. Not for RGBA voxels.
        AVERAGE,
        /// The integral of the value, as a fraction of the range, over the length in opacity units,
        /// then looked up as a fraction: choose the opacity unit such that sums lie in [0, 1]. Not
        /// for RGBA voxels.
        SUM,
        /// The first place where the interpolated value crosses the iso-value, opaque, in the
        /// table's colour; needs a region that is convex per brick. Not for RGBA voxels. Where the
        /// ray enters with a value already beyond there is no surface.
        ISOSURFACE
    };
    /// The names of the ray functions, in files too, in the order of their values.
    static constexpr const char* const RAY_FUNCTION_NAMES[] = {
        "COMPOSITE", "MAXIMUM", "MINIMUM", "AVERAGE", "SUM", "ISOSURFACE"};
    /// Selects what volumes do to one another where they overlap.
    enum CombineRule
    {
        /// Extinctions add, and each emits its own colour: clouds in one another.
        ABSORB,
        /// The volume shows nothing by itself, and neither emits nor absorbs: it paints the others.
        /// Where its table gives colour p and opacity a (of a layer one unit thick), the colours
        /// that overlapping volumes emit, lit or not, are multiplied by 1 - a + a * p; their
        /// opacity stays. Several paint one after another, in any order. So a dose is painted over
        /// anatomy. Neither lit nor composited itself, its ray function does not matter;
        /// interpolation is nearest or linear, lookup after interpolation. Needs voxels in a convex
        /// region, in one voxel frame; at most four of its bricks may overlap a volume. Volumes
        /// with a ray function that gathers values are not painted.
        PAINT
    };
    /// Selects how gradients for shading are found: central differences over a sample's distance,
    /// since the derivative of what is linear between samples jumps at each of them, and is of
    /// first order only.
    enum Gradients
    {
        /// Six more samples of the voxels each time, and no memory; of CUBIC, whose derivative is
        /// continuous, that, at the price of one more sample.
        ON_THE_FLY,
        /// One sample of a texture that holds gradients besides values; four times the memory (of
        /// 8-bit voxels eight times).
        PRECOMPUTED
    };

    META_Object(osgVolumizer, VolumeAppearance);

    VolumeAppearance();
    /// Shares voxels, table and cut with `o`. With DEEP_COPY_OBJECTS, and so with DEEP_COPY_ALL, it
    /// has its own of each, down to the samples: to copy a subgraph and share its volumes, leave
    /// that flag out (`DEEP_COPY_ALL & ~DEEP_COPY_OBJECTS`). As with all that OSG copies, what
    /// several appearances share becomes one for each.
    VolumeAppearance(const VolumeAppearance& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Visits as any group does, but osgUtil::Optimizer takes no transform from above it.
    void accept(osg::NodeVisitor& visitor) override;

    void setVoxels(Voxels* voxels);
    Voxels* getVoxels() const { return _voxels.get(); }
    /// Never null; setting null restores the default ramp.
    void setLookupTable(LookupTable* table);
    LookupTable* getLookupTable() const { return _lookupTable.get(); }

    /// What is left of the volume; null (default): all of it. No volume that paints others is cut
    /// by more than planes.
    void setCut(VolumeCut* cut);
    VolumeCut* getCut() const { return _cut.get(); }

    void setTechnique(Technique technique) { _technique = technique; }
    Technique getTechnique() const { return _technique; }
    void setInterpolation(Interpolation interpolation);
    Interpolation getInterpolation() const { return _interpolation; }
    void setLookup(Lookup lookup) { _lookup = lookup; }
    Lookup getLookup() const { return _lookup; }
    /// Texture units often interpolate with 8-bit weights, and some also round 8-bit samples to 8
    /// bits. On: interpolation in 32-bit floats from fetched samples, about half as fast. Off by
    /// default; on where an error tolerance needs it.
    void setExactFiltering(bool exact) { _exactFiltering = exact; }
    bool getExactFiltering() const { return _exactFiltering; }
    void setRayFunction(RayFunction function) { _rayFunction = function; }
    RayFunction getRayFunction() const { return _rayFunction; }
    /// The data value of ISOSURFACE; finite. Default 0.5.
    ReportedStatus setIsoValue(double dataValue);
    double getIsoValue() const { return _isoValue; }

    /// Lights the volume with the scene's lights (osg::LightSource, the viewer's head light; up to
    /// eight, a head light where there is none): Blinn-Phong, two-sided, normals from the gradient.
    /// Off by default. Where the voxels do not vary there is no normal, and only ambient light.
    void setShading(bool shading);
    bool getShading() const { return _shading; }
    /// colour * (ambient + sum over lights (light's ambient + diffuse * light's diffuse * |n l|)) +
    /// specular * light's specular * |n h|^shininess; each coefficient in [0, 1000] (more
    /// would overflow 16-bit floats), shininess in [0, 1e7]. Defaults 0.2, 0.8, 0.3, 32.
    struct Material
    {
        double ambient = 0.2, diffuse = 0.8, specular = 0.3, shininess = 32.0;
    };
    ReportedStatus setMaterial(const Material& material);
    const Material& getMaterial() const { return _material; }
    void setCombineRule(CombineRule rule) { _combineRule = rule; }
    CombineRule getCombineRule() const { return _combineRule; }
    void setGradients(Gradients gradients) { _gradients = gradients; }
    Gradients getGradients() const { return _gradients; }

    /// Bits per colour channel, 8, 16 or 32 (default), that volumes are accumulated in, whatever
    /// the framebuffer has; in one view the largest of its volumes. 8 bits round every blend.
    ReportedStatus setAccumulationBits(int bits);
    int getAccumulationBits() const { return _accumulationBits; }

    /// Samples that bricks must share for interpolation and shading to show no seams: 1, and 2 more
    /// each for CUBIC and for shading. The voxels' overlap is raised to this where it is less, as
    /// soon as there are both. Where bricks are too small for that, or it is set to less later, an
    /// error is reported, CUBIC falls back to LINEAR, and shading shows seams.
    int getRequiredOverlap() const;

    void setSamplingMode(SamplingMode mode) { _sampling.mode = mode; }
    SamplingMode getSamplingMode() const { return _sampling.mode; }
    void setSamplingSpace(SamplingSpace space) { _sampling.space = space; }
    SamplingSpace getSamplingSpace() const { return _sampling.space; }
    /// Distance between samples along the view, in voxels, per voxel axis; default 1. Each
    /// from 1e-18 to 1e18, which floats can still square.
    ReportedStatus setSamplingPeriod(const osg::Vec3d& periodVoxel);
    osg::Vec3d getSamplingPeriod() const;
    /// Bound on the number of sampling surfaces; >= 1, default 4096. The largest int is none; but
    /// no view takes more than 65536, whatever period and bound ask for.
    ReportedStatus setMaximumSamples(int count);
    int getMaximumSamples() const { return _sampling.maximumSamples; }
    const core::SamplingParameters& getSamplingParameters() const { return _sampling; }

    /// The root mean square error, in units of full intensity, that sampling may make in a picture:
    /// the cheapest of equal steps, with the table or its integrals, of steps that are as long as
    /// the light that they give allows, and of CELL_BY_CELL is chosen by what each makes of some
    /// random rays through the data, and the sampling period is not used. One choice for all views.
    /// Kept from 1e-2 to 1e-5 with voxels of any kind; where not, the least is taken, and said
    /// once: see Settings::expectedError. What is lit is judged as lit by one white light, from the
    /// eye and from elsewhere, as bright as all lights of the scenes that it was drawn in. A frame
    /// spends some 10 ms on it after a change of data or table, lit 18; the rest is done by another
    /// thread, and meanwhile, for about a second, lit for some, frames are as fine as data of any
    /// kind need.
    /// Composited slabs of voxels of one component. 0 (default): as the period says.
    ReportedStatus setErrorTolerance(double rootMeanSquare);
    double getErrorTolerance() const { return _errorTolerance; }
    /// Seconds that a frame may take while the view moves: the period is lengthened little by
    /// little until it does, and is what was asked for again in the first frame in which the view
    /// rests (a viewer that draws on demand has to draw that one). 0 (default): always what was
    /// asked for.
    ReportedStatus setTargetFrameTime(double seconds);
    double getTargetFrameTime() const { return _targetFrameTime; }

    /// Of voxels with time steps (see VoxelSource::stepCount()): the step that is shown at
    /// simulation time 0 of the viewer's frame stamp, and by how many it moves on in a second of
    /// it, over and over: forwards or, below 0, backwards; 0 (default): not at all. Finite. A step
    /// that is not there yet is shown once all of it is, and until then the one before.
    ReportedStatus setTimeStep(double step);
    double getTimeStep() const { return _timeStep; }
    ReportedStatus setTimeRate(double stepsPerSecond);
    double getTimeRate() const { return _timeRate; }
    /// On: values between two steps are interpolated linearly, and the last step is followed by
    /// the first at once; about half as fast. Off (default): those of the step before. No effect
    /// with PAINT.
    void setTimeBlending(bool blending) { _timeBlending = blending; }
    bool getTimeBlending() const { return _timeBlending; }
    /// The step at a simulation time in seconds, 0 to the number of steps: within [i, i + 1) step i
    /// is shown, or a blend of i and i + 1.
    double getTimeStepAt(double simulationTime) const;

    /// Thickness, in object units, of the layer that the table's opacity is stated for; 0 (default)
    /// takes the voxels' mean spacing. Else from 1e-18 to 1e18, which floats can still square.
    ReportedStatus setOpacityUnit(double objectUnits);
    double getOpacityUnit() const { return _opacityUnit; }
    /// The unit in force.
    double getEffectiveOpacityUnit() const;

    /// How opaque what lies in front of a place has to be, that place included, for a pick to find
    /// the volume there (see interact/Pick.h). Above 0, below 1; default 0.5.
    ReportedStatus setPickOpacity(double opacity);
    double getPickOpacity() const { return _pickOpacity; }

    /// The settings that a volume is drawn with. They differ from those of the appearance where its
    /// geometry or voxels do not allow these, and where the choice was left to the library.
    struct Settings
    {
        Technique technique = SLABS;
        Interpolation interpolation = LINEAR;
        Lookup lookup = AFTER_INTERPOLATION;
        RayFunction rayFunction = COMPOSITE;
        bool shading = false;
        /// Filtering is exact: asked for, or needed for an error tolerance. Whether it is needed is
        /// measured in each context; here it is said for the least precise one that there is.
        bool exactFiltering = false;
        /// Root mean square error that is expected of an error tolerance, more than that where it
        /// cannot be kept; 0: none was asked for, or it is not known yet.
        double expectedError = 0.0;
        /// A cheaper sampling is being looked for than the one in force, which keeps the tolerance:
        /// frames, and calls of this, go on with it.
        bool refining = false;
        /// A sentence for each that differs from what was asked for.
        std::vector<std::string> reasons;
    };
    /// Finds the settings for `geometry`, which need not lie below. Decides as a frame does, and so
    /// may read voxels. May be called from any thread between changes.
    Settings getSettingsInForce(const VolumeGeometry& geometry) const;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~VolumeAppearance() override;

private:
    friend struct RenderDataAccess;

    void requireOverlap();

    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<LookupTable> _lookupTable;
    osg::ref_ptr<VolumeCut> _cut;
    Technique _technique = AUTOMATIC;
    Interpolation _interpolation = LINEAR;
    Lookup _lookup = AUTOMATIC_LOOKUP;
    bool _exactFiltering = false;
    RayFunction _rayFunction = COMPOSITE;
    double _isoValue = 0.5;
    bool _shading = false;
    Material _material;
    Gradients _gradients = ON_THE_FLY;
    CombineRule _combineRule = ABSORB;
    int _accumulationBits = 32;
    core::SamplingParameters _sampling;
    double _errorTolerance = 0.0, _targetFrameTime = 0.0;
    double _timeStep = 0.0, _timeRate = 0.0;
    bool _timeBlending = false;
    double _opacityUnit = 0.0, _pickOpacity = 0.5;
    mutable RenderDataSlot _renderData; // textures of the table, sampling that was chosen
};

} // namespace osgVolumizer
