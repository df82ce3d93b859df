#include "LatticeDeformer.h"

#include "../VolumeGeometry.h"
#include "../Voxels.h"
#include "private/GlmToOsg.h"

#include <string>
#include <utility>

namespace osgVolumizer {

namespace {

glm::ivec3 toIvec3(const osg::Vec3i& v)
{
    return {v.x(), v.y(), v.z()};
}

std::vector<osg::Vec3d> restPoints(const core::Lattice& lattice)
{
    std::vector<osg::Vec3d> points;
    for (std::size_t i = 0; i < lattice.count(); ++i)
        points.push_back(picking::toOsg(lattice.restPoint(i)));
    return points;
}

} // namespace

Result<osg::ref_ptr<LatticeDeformer>> LatticeDeformer::create(VolumeGeometry* geometry,
                                                              const Voxels& voxels,
                                                              const osg::BoundingBoxd& box,
                                                              const osg::Vec3i& points,
                                                              const osg::Vec3i& cells)
{
    core::Lattice lattice;
    lattice.box = {picking::toGlm(box._min), picking::toGlm(box._max)};
    lattice.points = toIvec3(points);
    if (Status status = lattice.validate(); !status) return status;
    osg::ref_ptr<LatticeDeformer> deformer = new LatticeDeformer(geometry, voxels, lattice, cells);
    if (Status status = deformer->bend(restPoints(lattice)); !status) return status;
    return deformer;
}

LatticeDeformer::LatticeDeformer(VolumeGeometry* geometry, const Voxels& voxels,
                                 core::Lattice lattice, const osg::Vec3i& cells)
    : _geometry(geometry), _lattice(std::move(lattice)), _cells(toIvec3(cells)),
      _origin(picking::toGlm(voxels.getOrigin())), _spacing(picking::toGlm(voxels.getSpacing()))
{
}

LatticeDeformer::~LatticeDeformer() = default;

Status LatticeDeformer::bend(std::vector<osg::Vec3d> points)
{
    core::Lattice lattice = _lattice;
    if (points.size() != lattice.count())
        return {ErrorCode::SIZE_MISMATCH, "a lattice: " + std::to_string(points.size()) +
                                              " points are given, expected " +
                                              std::to_string(lattice.count())};
    lattice.offsets.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        lattice.offsets[i] = picking::toGlm(points[i]) - lattice.restPoint(i);
    Result<core::TetraSet> bent = lattice.tessellate(_cells, _origin, _spacing);
    if (!bent.ok()) return bent.status;
    const CallerReports quiet;
    Status status = _geometry->setTetraSet(std::move(bent.value));
    if (!status) return status;
    _lattice = std::move(lattice);
    _points = std::move(points);
    ++_modifiedCount;
    return {};
}

osg::Vec3i LatticeDeformer::getNumPoints() const
{
    return {_lattice.points.x, _lattice.points.y, _lattice.points.z};
}

unsigned LatticeDeformer::numberOf(int i, int j, int k) const
{
    return static_cast<unsigned>((k * _lattice.points.y + j) * _lattice.points.x + i);
}

osg::Vec3d LatticeDeformer::getRestPoint(unsigned number) const
{
    return picking::toOsg(_lattice.restPoint(number));
}

ReportedStatus LatticeDeformer::setPoint(unsigned number, const osg::Vec3d& point)
{
    if (number >= getNumAllPoints())
        return reported({ErrorCode::INDEX_OUT_OF_RANGE,
                         "a lattice: there is no point " + std::to_string(number) + ", but " +
                             std::to_string(getNumAllPoints()) + " of them",
                         number});
    std::vector<osg::Vec3d> points = _points;
    points[number] = point;
    return setPoints(points);
}

ReportedStatus LatticeDeformer::setPoints(const std::vector<osg::Vec3d>& points)
{
    return reported(bend(points));
}

void LatticeDeformer::reset()
{
    reportError(bend(restPoints(_lattice)));
}

} // namespace osgVolumizer
