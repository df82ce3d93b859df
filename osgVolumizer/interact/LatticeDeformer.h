#pragma once

#include "../Error.h"
#include "../core/Export.h"
#include "../core/geometry/Lattice.h"

#include <osg/BoundingBox>
#include <osg/Referenced>
#include <osg/Vec3d>
#include <osg/Vec3i>
#include <osg/ref_ptr>

#include <vector>

namespace osgVolumizer {

class VolumeGeometry;
class Voxels;

/// Bends a box of a volume by a lattice of control points (see core::Lattice): free-form
/// deformation. The box becomes tetrahedra of a VolumeGeometry, whose voxel coordinates stay while
/// their positions follow the points, so that what is shown bends with them. To be changed between
/// frames. Scene files keep the bent geometry, not its lattice.
class OSGVOLUMIZER_EXPORT LatticeDeformer : public osg::Referenced
{
public:
    /// Takes over a geometry, which becomes the box as it is by itself. Expects one. Refuses
    /// (VALUE_INVALID) a box without volume, fewer than 2 or more than 16 points along an axis, and
    /// fewer than 1 or more than 64 cells. \param voxels that are shown; their origin and spacing
    /// now say what is where at rest \param box object frame; what of it lies outside the voxels
    /// shows nothing \param cells hexahedra that the box is cut into: the more the smoother, and
    /// the slower
    static Result<osg::ref_ptr<LatticeDeformer>>
    create(VolumeGeometry* geometry, const Voxels& voxels, const osg::BoundingBoxd& box,
           const osg::Vec3i& points, const osg::Vec3i& cells);

    VolumeGeometry* getGeometry() const { return _geometry.get(); }
    osg::Vec3i getNumPoints() const;
    unsigned getNumAllPoints() const { return static_cast<unsigned>(_lattice.count()); }
    /// Points are counted along x first, then y, then z.
    unsigned numberOf(int i, int j, int k) const;
    /// Object frame. Expects a number below getNumAllPoints().
    const osg::Vec3d& getPoint(unsigned number) const { return _points[number]; }
    osg::Vec3d getRestPoint(unsigned number) const;
    const std::vector<osg::Vec3d>& getPoints() const { return _points; }
    /// Refuses, and changes nothing: a number that there is not (INDEX_OUT_OF_RANGE), another
    /// number of points than there are (SIZE_MISMATCH), points that are not finite, and
    /// (VALUE_INVALID, with the number of the tetrahedron) a lattice that folds over.
    ReportedStatus setPoint(unsigned number, const osg::Vec3d& point);
    ReportedStatus setPoints(const std::vector<osg::Vec3d>& points);
    /// All points to their places at rest.
    void reset();

    /// The lattice as it is: where it leads any point of the box.
    const core::Lattice& getLattice() const { return _lattice; }
    /// Grows with every change.
    unsigned getModifiedCount() const { return _modifiedCount; }

protected:
    LatticeDeformer(VolumeGeometry* geometry, const Voxels& voxels, core::Lattice lattice,
                    const osg::Vec3i& cells);
    ~LatticeDeformer() override;

private:
    Status bend(std::vector<osg::Vec3d> points);

    const osg::ref_ptr<VolumeGeometry> _geometry;
    core::Lattice _lattice;
    std::vector<osg::Vec3d> _points;
    const glm::ivec3 _cells;
    const glm::dvec3 _origin, _spacing;
    unsigned _modifiedCount = 0;
};

} // namespace osgVolumizer
