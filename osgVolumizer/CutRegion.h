#pragma once

#include "Error.h"
#include "Voxels.h"
#include "core/cutting/TriangleMesh.h"

#include <osg/BoundingBox>
#include <osg/Vec3d>
#include <osg/Vec4d>
#include <osg/ref_ptr>

#include <limits>
#include <memory>
#include <vector>

namespace osg {
class Drawable;
}

namespace osgVolumizer {

/// A region of space that a VolumeCut keeps, in the frame of the voxels as they lie by themselves:
/// origin + spacing * voxel, object units. So it moves and bends with the volume. A value: copies
/// share what cannot be changed.
class OSGVOLUMIZER_EXPORT CutRegion
{
public:
    enum Kind
    {
        HALF_SPACE,
        BOX,
        SPHERE,
        SURFACE,
        MASK
    };

    /// All that voxels can fill: within 1e18.
    CutRegion() = default;
    /// Where x, y, z, w times (point, 1) >= 0.
    static CutRegion halfSpace(const osg::Vec4d& plane);
    static CutRegion box(const osg::BoundingBoxd& box);
    static CutRegion sphere(const osg::Vec3d& center, double radius);
    /// The inside of a closed surface: the triangles of a drawable, or of a mesh. Where it is open
    /// otherwise, vertices nearer to each other than floats tell apart, or than 1e-4 of its size,
    /// count as one.
    static CutRegion surface(const osg::Drawable& triangles);
    static CutRegion surface(const core::TriangleMesh& mesh);
    /// Where another volume has values from `low` to `high`, with its own origin and spacing; none
    /// of it lies outside. Without an upper bound values are interpolated; with both, as for
    /// labels, it is whether samples are within them. The mask is read when the cut is first drawn
    /// or picked, and again after VolumeCut::dirty().
    static CutRegion mask(Voxels* voxels, double low,
                          double high = std::numeric_limits<double>::infinity());

    /// What lies outside.
    CutRegion complement() const;
    bool isComplement() const { return _complement; }

    Kind getKind() const { return _kind; }
    const osg::Vec4d& getPlane() const { return _plane; }
    const osg::BoundingBoxd& getBox() const { return _box; }
    const osg::Vec3d& getCenter() const { return _center; }
    double getRadius() const { return _radius; }
    /// Never null; empty but for SURFACE.
    const std::shared_ptr<const core::TriangleMesh>& getMesh() const { return _mesh; }
    Voxels* getMask() const { return _mask.get(); }
    double getMaskLow() const { return _low; }
    double getMaskHigh() const { return _high; }

    /// Refuses (VALUE_INVALID) a plane without a direction, a box without volume, a radius that is
    /// not above 0, surfaces that core::checkClosed() refuses, a mask without voxels, with a range
    /// that is none, or paged; and what is not finite.
    Status validate() const;

private:
    static CutRegion surface(const core::TriangleMesh& mesh, bool floats);

    Kind _kind = HALF_SPACE;
    bool _complement = false;
    osg::Vec4d _plane{0.0, 0.0, 1.0, 1e18};
    osg::BoundingBoxd _box;
    osg::Vec3d _center;
    double _radius = 0.0;
    std::shared_ptr<const core::TriangleMesh> _mesh = std::make_shared<core::TriangleMesh>();
    osg::ref_ptr<Voxels> _mask;
    double _low = 0.0, _high = 0.0;
};

} // namespace osgVolumizer
