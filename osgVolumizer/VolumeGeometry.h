#pragma once

#include "Error.h"
#include "RenderData.h"
#include "core/Export.h"
#include "core/geometry/TetraSet.h"

#include <osg/Drawable>
#include <osg/Vec2d>

#include <memory>
#include <string>
#include <vector>

namespace osgVolumizer {

class Voxels;

/// The region of space that is filled: tetrahedra, in the object frame. It is drawn with the
/// nearest VolumeAppearance above it; transforms may stand between the two. Without explicit voxel
/// coordinates a vertex at p shows the voxel at (p - origin)/spacing.
///
/// A Drawable rather than a plain Node, so that OSG's Optimizer keeps transforms above it, and
/// never an osg::Geometry, so that it does not flatten them into it (see also accept()).
class OSGVOLUMIZER_EXPORT VolumeGeometry : public osg::Drawable
{
public:
    META_Object(osgVolumizer, VolumeGeometry);

    /// Selects the tetrahedra that a box is cut into.
    enum BoxTessellation
    {
        FIVE,
        TWENTY_FOUR,
        ENCLOSING
    };

    VolumeGeometry();
    /// Copies hold the same immutable tetrahedra until either is given others.
    VolumeGeometry(const VolumeGeometry& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// The box of all voxels.
    static osg::ref_ptr<VolumeGeometry> createBox(const Voxels& voxels);
    /// Any box, in the object frame. ENCLOSING is one tetrahedron around the box, which the bricks'
    /// clip boxes cut down to the voxels; it fills the box only where the voxels do.
    static osg::ref_ptr<VolumeGeometry> createBox(const osg::BoundingBoxd& box,
                                                  BoxTessellation tessellation = FIVE);

    /// Makes it that box: moves a region of interest through a volume of which not all is shown.
    /// Refused as by setTetraSet().
    ReportedStatus setBox(const osg::BoundingBoxd& box, BoxTessellation tessellation = FIVE);

    using TetraSetPtr = std::shared_ptr<const core::TetraSet>;
    /// Takes the tetrahedra; refused (see core::TetraSet::validate) leaves the old ones in place.
    ReportedStatus setTetraSet(core::TetraSet tetraSet);
    /// Never null. Immutable: a frame under way keeps the one it has.
    TetraSetPtr getTetraSet() const;
    /// Grows with every setTetraSet() and setFieldShader(). Thread safe.
    unsigned getModifiedCount() const;

    /// GLSL that makes what is shown of the user values of vertices (core::VertexFormat::userSize):
    /// it defines `vec4 shadeFields(vec4 color, float fields[FIELDS])`, which is called for every
    /// sample with the values there, linear in each tetrahedron, and with the colour that else is
    /// shown: straight linear RGB, and the opacity of a layer one opacity unit thick. Declarations
    /// begin their lines. Empty (default): user values are not looked at. Composited volumes only;
    /// TOO_LARGE for more than 1023 different ones in a process, and the old one stays.
    ReportedStatus setFieldShader(const std::string& glsl);
    std::string getFieldShader() const;

    /// What scalars belong to.
    enum ScalarBinding
    {
        PER_VERTEX,     ///< linear in each tetrahedron
        PER_TETRAHEDRON ///< one value in each
    };
    using ScalarsPtr = std::shared_ptr<const std::vector<float>>;
    /// Values that fill the tetrahedra in place of voxels: unstructured grids. The appearance's
    /// lookup table is applied to them, and its integral over each tetrahedron is exact, but where
    /// it is marched with other volumes, or a field shader changes it. Only they are sent to the
    /// card when they change, so that a time series on one mesh is cheap. Cells of values that are
    /// NaN or infinite are left out. SIZE_MISMATCH where there are not as many as vertices, or
    /// tetrahedra; the old ones stay.
    ReportedStatus setScalars(std::vector<float> scalars, ScalarBinding binding = PER_VERTEX);
    /// Back to voxels. setTetraSet() does that too where the number of scalars is no longer right.
    void removeScalars();
    /// Null where there are none. Immutable: a frame under way keeps those that it has.
    ScalarsPtr getScalars() const;
    ScalarBinding getScalarBinding() const;
    /// What the lookup table spans. VALUE_INVALID unless both are finite and the second is larger.
    ReportedStatus setScalarRange(const osg::Vec2d& range);
    /// Initially the lowest and highest of the finite scalars, whenever these are set.
    osg::Vec2d getScalarRange() const;
    bool isScalarRangeAutomatic() const;
    /// Grows with every change of scalars or their range. Thread safe.
    unsigned getScalarCount() const;
    /// All of these, as they are at one moment.
    struct ScalarField
    {
        ScalarsPtr values; ///< null for none
        ScalarBinding binding = PER_VERTEX;
        osg::Vec2d range{0.0, 1.0};
        unsigned count = 0;
    };
    ScalarField getScalarField() const;

    /// Slices of an earlier frame are drawn again while the view has turned by no more than this,
    /// in radians; 0 (default): only while nothing has changed. Saves polygonizing large meshes in
    /// every frame of a slow turn. Has no effect where translucent things are merged with the
    /// volume, and on slabs. Negative or not finite: VALUE_INVALID, and the old one stays.
    ReportedStatus setSlackAngle(double radians);
    double getSlackAngle() const;

    /// A cull registers the volume; an osgUtil::IntersectionVisitor finds what is seen of it (see
    /// interact/Pick.h); osgUtil::Optimizer takes no transform from above it.
    void accept(osg::NodeVisitor& visitor) override;
    osg::BoundingBox computeBoundingBox() const override;
    osg::BoundingSphere computeBound() const override;
    /// Draws nothing: volumes are drawn from per-view leaves, made in accept().
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~VolumeGeometry() override;

private:
    friend struct RenderDataAccess;
    friend struct PickDataAccess;
    struct Private;
    std::unique_ptr<Private> _private;
    mutable RenderDataSlot _renderData; // what frames reuse
    mutable RenderDataSlot _pickData;   // what picks reuse
};

} // namespace osgVolumizer
