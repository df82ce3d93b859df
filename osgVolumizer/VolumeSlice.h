#pragma once

#include "BrickDrawCallback.h"
#include "Error.h"
#include "LookupTable.h"
#include "RenderData.h"
#include "VolumeAppearance.h"
#include "VolumeGeometry.h"

#include <osg/Drawable>
#include <osg/Geometry>
#include <osg/Vec4d>

#include <memory>
#include <optional>
#include <vector>

namespace osgVolumizer {

namespace slices {
struct SliceAccess;
}

/// A surface through the voxels of the nearest VolumeAppearance above it, coloured by what they are
/// there: a plane, a polygon, or any geometry ("horizons"). Transforms may stand between the two,
/// as with VolumeGeometry: a place p of the object frame shows the voxel at (p - origin)/spacing.
///
/// A surface like any other: opaque, or in the transparent bin, and merged in depth with volumes;
/// cut by clip planes, in fog, found by OSG's intersectors. It is not lit. Only bricks and pages
/// that it touches are read and uploaded, and those that the volume is drawn from are shared with
/// it; of paged voxels (see Voxels::isPaged()) it is coarse until finer ones are there.
///
/// A Drawable and no osg::Geometry, so that OSG's Optimizer keeps transforms above it. To be
/// changed between frames. Whoever changes the voxels' size or place, or the region, calls
/// dirtyBound().
class OSGVOLUMIZER_EXPORT VolumeSlice : public osg::Drawable
{
public:
    META_Object(osgVolumizer, VolumeSlice);

    enum Shape
    {
        EMPTY,
        PLANE,
        POLYGON,
        GEOMETRY
    };
    /// What is shown of the values across a thick slab.
    enum Reduction
    {
        MEAN,
        MAXIMUM,
        MINIMUM
    };
    /// Their names, in files too, in the order of their values.
    static constexpr const char* const SHAPE_NAMES[] = {"EMPTY", "PLANE", "POLYGON", "GEOMETRY"};
    static constexpr const char* const REDUCTION_NAMES[] = {"MEAN", "MAXIMUM", "MINIMUM"};

    VolumeSlice();
    /// Shares geometry, region and table with `o`; has its own with CopyOp::DEEP_COPY_OBJECTS.
    VolumeSlice(const VolumeSlice& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    Shape getShape() const;
    /// The cross section of the region with the plane of the points p (object frame) with x, y, z,
    /// w times (p, 1) = 0; its normal is (x, y, z). VALUE_INVALID for a normal without length and
    /// for numbers that are not finite: then, as with all that is refused here, nothing changes.
    ReportedStatus setPlane(const osg::Vec4d& plane);
    ReportedStatus setPlane(const osg::Vec3d& point, const osg::Vec3d& normal);
    /// Of the last setPlane(), normal of length 1.
    osg::Vec4d getPlane() const;
    /// The part of the region in a polygon (object frame): planar to 1e-6 of its size, convex or
    /// not, its corners in either direction. VALUE_INVALID for fewer than three corners, no area,
    /// one that is not planar or crosses itself, and numbers that are not finite; TOO_LARGE for
    /// more than 1024 corners.
    ReportedStatus setPolygon(const std::vector<osg::Vec3d>& corners);
    const std::vector<osg::Vec3d>& getPolygon() const { return _polygon; }
    /// The triangles (strips, fans, quads, polygons) of a geometry, positions in the object frame,
    /// as far as they lie within the voxels. With a `placeUnit` of 0 or more the texture
    /// coordinates of that unit (three components a vertex) are where in the object frame each
    /// vertex is taken to be in the volume, wherever it is drawn. Kept is what there is now; where
    /// that changes it is to be set again. VALUE_INVALID without triangles, or with vertices that
    /// are not finite, or without such coordinates for all vertices.
    ReportedStatus setGeometry(osg::Geometry* geometry, int placeUnit = -1);
    osg::Geometry* getGeometry() const { return _geometry.get(); }
    int getPlaceUnit() const { return _placeUnit; }
    /// Shows nothing.
    void setEmpty();

    /// Planes and polygons show their cross section with these tetrahedra, which need not be in the
    /// scene; null (default): with the box of all voxels. Where they have voxel coordinates, those
    /// tell what is shown.
    void setRegion(VolumeGeometry* region);
    VolumeGeometry* getRegion() const { return _region.get(); }

    /// Colours of values, in place of the appearance's; null (default): those. Forgets a window.
    void setLookupTable(LookupTable* table);
    LookupTable* getLookupTable() const { return _lookupTable.get(); }
    /// The table that colours come from: its own, or of the window, or else the appearance's.
    const LookupTable* getTableInForce(const VolumeAppearance& appearance) const;
    /// Grey values instead: from black to white over `width` about `centre`, both data values; a
    /// negative width makes them fall, none makes them jump. Forgets a table. Finite.
    ReportedStatus setWindow(double centre, double width);
    /// Centre and width; none where there is no window.
    std::optional<osg::Vec2d> getWindow() const { return _window; }
    /// 1 (default): the slice is opaque, and volumes end at it; below: it is translucent.
    ReportedStatus setOpacity(double opacity);
    double getOpacity() const { return _opacity; }
    /// On: opacity is multiplied by the table's, whatever the thickness (of RGBA voxels: by
    /// theirs), and the slice is translucent. Off by default.
    void setUsesTableOpacity(bool uses) { _usesTableOpacity = uses; }
    bool getUsesTableOpacity() const { return _usesTableOpacity; }
    bool isTranslucent() const { return _opacity < 1.0 || _usesTableOpacity; }

    /// Default LINEAR. For CUBIC bricks need overlap 3 (see Voxels::setOverlap()); else it is
    /// reported, and LINEAR.
    void setInterpolation(VolumeAppearance::Interpolation how) { _interpolation = how; }
    VolumeAppearance::Interpolation getInterpolation() const { return _interpolation; }
    /// See VolumeAppearance::setExactFiltering(). Off by default.
    void setExactFiltering(bool exact) { _exactFiltering = exact; }
    bool getExactFiltering() const { return _exactFiltering; }

    /// A thick slab: object units along the surface's normal, half of them on each side. The values
    /// at the middles of equal layers across it are reduced to one, which is then looked up; those
    /// outside the voxels do not count, nor does the region. Surfaces have the normal of each
    /// triangle, where it is taken to be in the volume. 0 (default): the values on the surface
    /// itself. Not negative, no more than 1e18. Bricks that slabs reach across are read at a time
    /// as far as there are texture units: of more, the nearest are.
    ReportedStatus setThickness(double objectUnits);
    double getThickness() const { return _thickness; }
    void setReduction(Reduction reduction) { _reduction = reduction; }
    Reduction getReduction() const { return _reduction; }
    /// Thickness of a layer, in voxels along the normal, at most; default one half. No slab has
    /// more than 4096 layers.
    ReportedStatus setSamplingPeriod(double voxels);
    double getSamplingPeriod() const { return _samplingPeriod; }

    /// On: only what the appearance's cut leaves is shown (see VolumeAppearance::setCut()), its own
    /// surfaces included: places less than half a sample, or a cell of its grid, outside. Bricks
    /// are read, and intersectors find the slice, all the same. Off by default.
    void setFollowsCut(bool follows) { _followsCut = follows; }
    bool getFollowsCut() const { return _followsCut; }

    /// Draws in place of the slice, brick by brick, with the bricks' textures; null (default): the
    /// slice draws itself.
    void setBrickDrawCallback(BrickDrawCallback* callback) { _brickDrawCallback = callback; }
    BrickDrawCallback* getBrickDrawCallback() const { return _brickDrawCallback.get(); }

    void accept(osg::NodeVisitor& visitor) override;
    /// Hands over the triangles of the slice: so OSG's intersectors find it.
    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override;
    /// Of planes and polygons it depends on the voxels of the first appearance above; without one
    /// there are no bounds.
    osg::BoundingBox computeBoundingBox() const override;
    osg::BoundingSphere computeBound() const override;
    /// Draws nothing: slices are drawn from per-view leaves, made in accept().
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~VolumeSlice() override;

private:
    friend struct RenderDataAccess;
    friend struct slices::SliceAccess;
    struct Private;

    ReportedStatus refuse(Status status) const;
    ReportedStatus refuse(const char* field, double value, const char* expected) const;

    std::unique_ptr<Private> _private; // the shape, and its faces within voxels
    std::vector<osg::Vec3d> _polygon;
    osg::ref_ptr<osg::Geometry> _geometry;
    int _placeUnit = -1;
    osg::ref_ptr<VolumeGeometry> _region;
    osg::ref_ptr<LookupTable> _lookupTable, _windowTable;
    std::optional<osg::Vec2d> _window;
    double _opacity = 1.0;
    bool _usesTableOpacity = false, _exactFiltering = false, _followsCut = false;
    VolumeAppearance::Interpolation _interpolation = VolumeAppearance::LINEAR;
    double _thickness = 0.0, _samplingPeriod = 0.5;
    Reduction _reduction = MEAN;
    osg::ref_ptr<BrickDrawCallback> _brickDrawCallback;
    mutable RenderDataSlot _renderData; // meshes and tables of colours
};

} // namespace osgVolumizer
