#include "FaceCache.h"

#include "../RecencyCache.h"
#include "ViewHelpers.h"

#include <glm/geometric.hpp>

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

/// Faces and what they were made from.
struct Made
{
    std::shared_ptr<const TetraSet> tetraSet;
    std::vector<Box3d> clipBoxes;
    View view;
    SamplingParameters parameters;
    FaceCache::FacesPtr faces;
    /// AXIS_ALIGNED: the view axis, and whether the eye lies beyond all planes.
    ViewAxis axis;
    bool eyeOutside = false;
};

/// Whether the eye lies outside the set along the axis, so that the order of the planes cannot
/// depend on it. Bounds and eye in the position frame; explicit voxel coordinates may be bent, and
/// never count as outside.
bool eyeOutside(const TetraSet& set, const Box3d& bounds, const View& view, int axis)
{
    if (set.vertices.format().voxelCoordinateSize == 3) return false;
    const Result<glm::dvec4> eye = eyePosition(view);
    return eye.ok() &&
           (eye->w == 0.0 || (*eye)[axis] < bounds.min[axis] || (*eye)[axis] > bounds.max[axis]);
}

bool planesAcrossView(const SamplingParameters& p)
{
    return p.mode == SamplingMode::VIEWPORT_ALIGNED && p.space != SamplingSpace::VIEW_VOLUME &&
           !p.cullToView;
}

bool planesAlongAxis(const SamplingParameters& p)
{
    return p.mode == SamplingMode::AXIS_ALIGNED && !p.cullToView;
}

/// Angle between two directions, precise also where it is small.
double angle(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

struct FaceCache::Private
{
    explicit Private(std::size_t capacity) : entries(capacity) {}

    struct Entry
    {
        std::mutex mutex; ///< held while this view is looked up or polygonized
        Polygonizer polygonizer;
        Box3d bounds;
        Made made;
        std::vector<std::shared_ptr<PolygonizedFaces>> pool;

        bool reusable(const std::shared_ptr<const TetraSet>& set, const std::vector<Box3d>& boxes,
                      const View& view, const SamplingParameters& parameters, double slack) const;
        std::shared_ptr<PolygonizedFaces> takeFromPool();
        Status make(const std::shared_ptr<const TetraSet>& set, const std::vector<Box3d>& boxes,
                    const View& view, const SamplingParameters& parameters);
    };

    std::shared_ptr<Entry> entryOf(ViewId viewId);

    mutable std::mutex mutex; ///< guards the entries' list only
    RecencyCache<ViewId, std::shared_ptr<Entry>> entries;
};

FaceCache::FaceCache(std::size_t capacity) : _private(new Private(capacity)) {}
FaceCache::~FaceCache() = default;

bool FaceCache::Private::Entry::reusable(const std::shared_ptr<const TetraSet>& set,
                                         const std::vector<Box3d>& boxes, const View& view,
                                         const SamplingParameters& parameters, double slack) const
{
    if (!made.faces || made.tetraSet != set || !(made.parameters == parameters) ||
        made.clipBoxes != boxes)
        return false;
    if (made.view == view) return true;
    if (planesAcrossView(parameters)) {
        const glm::dvec3 then = made.view.depthGradient(), now = view.depthGradient();
        const bool same = then == now && made.view.toEye[3][2] == view.toEye[3][2];
        if (!same && !(slack > 0.0 && angle(then, now) <= slack)) return false;
        // A view that polygonize() would refuse is refused, whatever there is in the cache.
        return eyePosition(view).ok();
    }
    if (planesAlongAxis(parameters)) {
        const Result<ViewAxis> axis = closestAxis(view, bounds.center(), parameters.voxelSize);
        return axis.ok() && axis->axis == made.axis.axis && axis->sign == made.axis.sign &&
               made.eyeOutside && eyeOutside(*set, bounds, view, axis->axis);
    }
    return false;
}

std::shared_ptr<PolygonizedFaces> FaceCache::Private::Entry::takeFromPool()
{
    for (std::shared_ptr<PolygonizedFaces>& p : pool)
        if (p.use_count() == 1) {
            // What the last reader did happened before we write.
            std::atomic_thread_fence(std::memory_order_acquire);
            return p;
        }
    pool.push_back(std::make_shared<PolygonizedFaces>());
    return pool.back();
}

Status FaceCache::Private::Entry::make(const std::shared_ptr<const TetraSet>& set,
                                       const std::vector<Box3d>& boxes, const View& view,
                                       const SamplingParameters& parameters)
{
    if (polygonizer.tetraSet() != set) {
        if (Status s = polygonizer.setTetraSet(set); !s) return s;
        bounds = set->bounds();
    }
    if (Status s = polygonizer.setClipBoxes(boxes); !s) return s;
    made.faces.reset();
    const std::shared_ptr<PolygonizedFaces> out = takeFromPool();
    if (Status s = polygonizer.polygonize(view, parameters, *out); !s) return s;
    made.tetraSet = set;
    made.clipBoxes = boxes;
    made.view = view;
    made.parameters = parameters;
    made.faces = out;
    if (planesAlongAxis(parameters) && !set->empty()) {
        made.axis = *closestAxis(view, bounds.center(), parameters.voxelSize);
        made.eyeOutside = eyeOutside(*set, bounds, view, made.axis.axis);
    }
    return {};
}

std::shared_ptr<FaceCache::Private::Entry> FaceCache::Private::entryOf(ViewId viewId)
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (const auto* known = entries.find(viewId)) return *known;
    return entries.add(viewId, std::make_shared<Entry>());
}

Result<FaceCache::FacesPtr> FaceCache::faces(ViewId viewId,
                                             const std::shared_ptr<const TetraSet>& tetraSet,
                                             const std::vector<Box3d>& clipBoxes, const View& view,
                                             const SamplingParameters& parameters,
                                             double slackAngle, bool* polygonized)
{
    if (polygonized) *polygonized = false;
    if (!(slackAngle >= 0.0))
        return Status(ErrorCode::VALUE_INVALID,
                      "FaceCache: the slack angle is " + std::to_string(slackAngle) + ".");
    const std::shared_ptr<Private::Entry> entry = _private->entryOf(viewId);
    const std::lock_guard<std::mutex> lock(entry->mutex);
    if (entry->reusable(tetraSet, clipBoxes, view, parameters, slackAngle)) {
        return entry->made.faces;
    }
    if (Status s = entry->make(tetraSet, clipBoxes, view, parameters); !s) return s;
    if (polygonized) *polygonized = true;
    return entry->made.faces;
}

} // namespace core
} // namespace osgVolumizer
