#include "VolumeSlice.h"

#include "core/NumberRule.h"
#include "core/RecencyCache.h"
#include "core/Text.h"
#include "private/Copied.h"
#include "private/Flattening.h"
#include "private/OutwardBox.h"
#include "private/Renderer.h"
#include "private/SliceFaces.h"
#include "private/SliceShape.h"

#include <osg/PrimitiveSet>
#include <osgUtil/CullVisitor>

#include <cmath>
#include <limits>
#include <mutex>

namespace osgVolumizer {

struct VolumeSlice::Private
{
    /// What faces were made from.
    struct Key
    {
        unsigned shape, layout, region;
        bool operator==(const Key& o) const
        {
            return shape == o.shape && layout == o.layout && region == o.region;
        }
    };
    using FacesPtr = std::shared_ptr<const slices::SliceFaces>;

    mutable std::mutex mutex; ///< of what follows
    std::shared_ptr<const slices::SliceShape> shape = std::make_shared<const slices::SliceShape>();
    unsigned shapeCount = 0; ///< changes of shape or region
    core::RecencyCache<Key, FacesPtr> faces{4};

    void set(slices::SliceShape made)
    {
        auto shared = std::make_shared<const slices::SliceShape>(std::move(made));
        std::lock_guard<std::mutex> lock(mutex);
        shape = std::move(shared);
        ++shapeCount;
    }
    std::shared_ptr<const slices::SliceShape> get() const
    {
        std::lock_guard<std::mutex> lock(mutex);
        return shape;
    }
};

namespace SliceNode {

glm::dvec3 toDvec3(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

// The voxels of the first appearance above, along the first parents that have one.
const Voxels* voxelsAbove(const osg::Node& node)
{
    for (unsigned i = 0; i < node.getNumParents(); ++i) {
        const osg::Group* parent = node.getParent(i);
        if (const auto* appearance = dynamic_cast<const VolumeAppearance*>(parent)) {
            if (appearance->getVoxels()) return appearance->getVoxels();
            continue;
        }
        if (const Voxels* voxels = voxelsAbove(*parent)) return voxels;
    }
    return nullptr;
}

} // namespace SliceNode

VolumeSlice::VolumeSlice() : _private(new Private)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
}

VolumeSlice::VolumeSlice(const VolumeSlice& o, const osg::CopyOp& op)
    : osg::Drawable(o, op), _private(new Private), _polygon(o._polygon),
      _geometry(copied(o._geometry, op)), _placeUnit(o._placeUnit), _region(copied(o._region, op)),
      _lookupTable(copied(o._lookupTable, op)), _window(o._window), _opacity(o._opacity),
      _usesTableOpacity(o._usesTableOpacity), _exactFiltering(o._exactFiltering),
      _followsCut(o._followsCut), _interpolation(o._interpolation), _thickness(o._thickness),
      _samplingPeriod(o._samplingPeriod), _reduction(o._reduction),
      _brickDrawCallback(o._brickDrawCallback)
{
    _private->shape = o._private->get();
    if (_window) setWindow(_window->x(), _window->y());
}

VolumeSlice::~VolumeSlice() = default;

ReportedStatus VolumeSlice::refuse(Status status) const
{
    status.text = "VolumeSlice \"" + getName() + "\": " + status.text;
    return reported(std::move(status));
}

ReportedStatus VolumeSlice::refuse(const char* field, double value, const char* expected) const
{
    return refuse(
        {ErrorCode::VALUE_INVALID,
         std::string(field) + " is " + core::formatNumber(value) + ", expected " + expected});
}

VolumeSlice::Shape VolumeSlice::getShape() const
{
    return static_cast<Shape>(_private->get()->kind);
}

ReportedStatus VolumeSlice::setPlane(const osg::Vec4d& plane)
{
    Result<slices::SliceShape> shape =
        slices::planeShape({{plane.x(), plane.y(), plane.z()}, plane.w()});
    if (!shape.ok()) return refuse(shape.status);
    setEmpty();
    _private->set(std::move(shape.value));
    return {};
}

ReportedStatus VolumeSlice::setPlane(const osg::Vec3d& point, const osg::Vec3d& normal)
{
    const osg::Vec3d unit = normal / normal.length();
    return setPlane(osg::Vec4d(unit, -(unit * point)));
}

osg::Vec4d VolumeSlice::getPlane() const
{
    const auto shape = _private->get();
    if (shape->kind != slices::SliceShape::PLANE) return osg::Vec4d(0.0, 0.0, 1.0, 0.0);
    const core::Plane& plane = shape->plane;
    return {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
}

ReportedStatus VolumeSlice::setPolygon(const std::vector<osg::Vec3d>& corners)
{
    std::vector<glm::dvec3> polygon;
    for (const osg::Vec3d& corner : corners)
        polygon.push_back(SliceNode::toDvec3(corner));
    Result<slices::SliceShape> shape = slices::polygonShape(polygon);
    if (!shape.ok()) return refuse(shape.status);
    const std::vector<osg::Vec3d> kept = corners; // which may be the slice's own
    setEmpty();
    _polygon = kept;
    _private->set(std::move(shape.value));
    return {};
}

ReportedStatus VolumeSlice::setGeometry(osg::Geometry* geometry, int placeUnit)
{
    Result<slices::SliceShape> shape = slices::triangleShape(geometry, placeUnit);
    if (!shape.ok()) return refuse(shape.status);
    const osg::ref_ptr<osg::Geometry> kept = geometry;
    setEmpty();
    _geometry = kept;
    _placeUnit = placeUnit;
    _private->set(std::move(shape.value));
    return {};
}

void VolumeSlice::setEmpty()
{
    _polygon.clear();
    _geometry = nullptr;
    _placeUnit = -1;
    _private->set(slices::SliceShape());
    dirtyBound();
}

void VolumeSlice::setRegion(VolumeGeometry* region)
{
    _region = region;
    {
        std::lock_guard<std::mutex> lock(_private->mutex);
        ++_private->shapeCount;
    }
    dirtyBound();
}

void VolumeSlice::setLookupTable(LookupTable* table)
{
    _lookupTable = table;
    _windowTable = nullptr;
    _window.reset();
}

const LookupTable* VolumeSlice::getTableInForce(const VolumeAppearance& appearance) const
{
    if (_windowTable) return _windowTable.get();
    return _lookupTable ? _lookupTable.get() : appearance.getLookupTable();
}

ReportedStatus VolumeSlice::setWindow(double centre, double width)
{
    if (!core::FINITE.holds(centre))
        return refuse("centre of the window", centre, "a finite number");
    if (!core::FINITE.holds(width)) return refuse("width of the window", width, "a finite number");
    const double half = 0.5 * std::abs(width);
    const double low = width < 0.0 ? 1.0 : 0.0, high = 1.0 - low;
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const ReportedStatus status =
        table->setPoints({{centre - half, glm::dvec4(glm::dvec3(low), 1.0)},
                          {centre + half, glm::dvec4(glm::dvec3(high), 1.0)}},
                         LookupTable::DATA_VALUES);
    if (!status.ok()) return status;
    _lookupTable = nullptr;
    _windowTable = table;
    _window = osg::Vec2d(centre, width);
    return {};
}

ReportedStatus VolumeSlice::setOpacity(double opacity)
{
    if (!(opacity >= 0.0 && opacity <= 1.0))
        return refuse("opacity", opacity, "a number from 0 to 1");
    _opacity = opacity;
    return {};
}

ReportedStatus VolumeSlice::setThickness(double objectUnits)
{
    if (!core::LENGTH_OR_NONE.holds(objectUnits))
        return refuse("thickness", objectUnits, core::LENGTH_OR_NONE.expected);
    _thickness = objectUnits;
    return {};
}

ReportedStatus VolumeSlice::setSamplingPeriod(double voxels)
{
    if (!core::LENGTH.holds(voxels))
        return refuse("sampling period", voxels, core::LENGTH.expected);
    _samplingPeriod = voxels;
    return {};
}

std::shared_ptr<const slices::SliceFaces> slices::SliceAccess::faces(const VolumeSlice& slice,
                                                                     const Voxels& voxels)
{
    VolumeSlice::Private& known = *slice._private;
    const VolumeGeometry* region = slice._region.get();
    VolumeSlice::Private::Key key{0, voxels.getLayoutCount(),
                                  region ? region->getModifiedCount() + 1 : 0};
    std::shared_ptr<const slices::SliceShape> shape;
    {
        std::lock_guard<std::mutex> lock(known.mutex);
        key.shape = known.shapeCount;
        shape = known.shape;
        if (const auto* found = known.faces.find(key)) return *found;
    }
    const VolumeGeometry::TetraSetPtr set = region ? region->getTetraSet() : nullptr;
    Result<std::shared_ptr<const slices::SliceFaces>> made =
        slices::makeSliceFaces(*shape, voxels, set.get());
    if (!made.ok()) (void)slice.refuse(made.status);
    std::lock_guard<std::mutex> lock(known.mutex);
    return known.faces.add(key, made.value);
}

void VolumeSlice::accept(osg::NodeVisitor& visitor)
{
    if (!visitor.validNodeMask(*this) || keepsTransforms(*this, visitor)) return;
    visitor.pushOntoNodePath(this);
    osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor();
    Renderer* renderer = getRenderer();
    if (cullVisitor && renderer)
        renderer->cull(*this, *cullVisitor);
    else if (!cullVisitor)
        visitor.apply(static_cast<osg::Drawable&>(*this));
    visitor.popFromNodePath();
}

void VolumeSlice::accept(osg::PrimitiveFunctor& functor) const
{
    const Voxels* voxels = SliceNode::voxelsAbove(*this);
    const auto faces =
        voxels && voxels->valid() ? slices::SliceAccess::faces(*this, *voxels) : nullptr;
    if (!faces) return;
    std::vector<osg::Vec3> vertices;
    std::vector<unsigned> indices;
    const core::PolygonSet& polygons = faces->polygons;
    for (std::size_t f = 0; f < polygons.faceCount(); ++f) {
        const auto first = static_cast<unsigned>(vertices.size());
        for (std::size_t c = 0; c < polygons.size(f); ++c) {
            const glm::dvec3 p = polygons.position(f, c) + faces->center;
            vertices.emplace_back(osg::Vec3d(p.x, p.y, p.z));
            if (c >= 2)
                indices.insert(indices.end(),
                               {first, first + unsigned(c) - 1, first + unsigned(c)});
        }
    }
    if (indices.empty()) return;
    functor.setVertexArray(static_cast<unsigned>(vertices.size()), vertices.data());
    functor.drawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), indices.data());
}

osg::BoundingBox VolumeSlice::computeBoundingBox() const
{
    const Voxels* voxels = SliceNode::voxelsAbove(*this);
    const auto faces =
        voxels && voxels->valid() ? slices::SliceAccess::faces(*this, *voxels) : nullptr;
    if (!faces || faces->bounds.empty()) return {};
    return outwardBox(faces->bounds);
}

osg::BoundingSphere VolumeSlice::computeBound() const
{
    // As VolumeGeometry has it: osg::Drawable takes the box for known once the sphere is.
    _boundingBox = _initialBoundingBox;
    _boundingBox.expandBy(_computeBoundingBoxCallback
                              ? _computeBoundingBoxCallback->computeBound(*this)
                              : computeBoundingBox());
    if (!_boundingBox.valid()) return {};
    return {_boundingBox.center(), _boundingBox.radius() * (1.0f + 1e-6f)};
}

void VolumeSlice::drawImplementation(osg::RenderInfo&) const {}

void VolumeSlice::resizeGLObjectBuffers(unsigned int maximum)
{
    osg::Drawable::resizeGLObjectBuffers(maximum);
    _renderData.resizeGLObjectBuffers(maximum);
}

void VolumeSlice::releaseGLObjects(osg::State* state) const
{
    osg::Drawable::releaseGLObjects(state);
    _renderData.releaseGLObjects(state);
}

} // namespace osgVolumizer
