#include "GeometryCache.h"

#include "../../Outlines.h"
#include "../../VolumeGeometry.h"
#include "../../Voxels.h"
#include "../../private/FieldShaders.h"
#include "SliceCache.h"

#include "../context/ReportOnce.h"

namespace osgVolumizer {
namespace render {

GeometryCache::GeometryCache() : _slices(std::make_shared<SliceCache>()) {}

GeometryCache::Key GeometryCache::keyOf(const VolumeGeometry& geometry, const Voxels* voxels)
{
    const bool scalars = geometry.getScalars() != nullptr;
    if (scalars) voxels = nullptr;
    return {geometry.getModifiedCount(), voxels, voxels ? voxels->getLayoutCount() : 0, scalars};
}

std::shared_ptr<const PreparedGeometry> GeometryCache::get(const VolumeGeometry& geometry,
                                                           const Voxels* voxels)
{
    const Key key = keyOf(geometry, voxels);
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _prepared.find(key)) return *known;
    const auto set = geometry.getTetraSet();
    if (set->empty()) return _prepared.add(key, nullptr);
    return _prepared.add(
        key, prepareGeometry(*set, voxels, key.scalars,
                             std::max(fieldShaderNumber(geometry.getFieldShader()), 0)));
}

std::shared_ptr<const TetraTextures> GeometryCache::tetrahedra(const VolumeGeometry& geometry,
                                                               const Voxels* voxels)
{
    const auto prepared = get(geometry, voxels);
    const Key key = keyOf(geometry, voxels);
    std::lock_guard<std::mutex> lock(_mutex);
    const auto* known = _graphs.find(key);
    auto textures = known ? *known : nullptr;
    if (!textures) {
        textures = makeTetraTextures(prepared->tetras, !prepared->voxelFrame);
        if (textures->isOdd)
            reportOnce({ErrorCode::VALUE_INVALID,
                        "VolumeGeometry \"" + geometry.getName() + "\": " + textures->oddities});
    }
    if (prepared->scalars && textures->scalarCount != geometry.getScalarCount())
        textures = withScalars(*textures, geometry);
    return known && *known == textures ? textures : _graphs.add(key, textures);
}

osg::ref_ptr<osg::Geometry> GeometryCache::outlines(const VolumeGeometry& geometry,
                                                    const Voxels* voxels)
{
    const auto prepared = get(geometry, voxels);
    const Key key = keyOf(geometry, voxels);
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _outlines.find(key)) return *known;
    core::LineSet lines;
    core::outlineTetrahedra(prepared->tetras, lines);
    if (voxels && prepared->voxelFrame) core::outlineBoxes(brickOutlines(*voxels), lines);
    return _outlines.add(key, createLines(lines));
}

void GeometryCache::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& lines : _outlines)
        lines.value->resizeGLObjectBuffers(maximum);
    for (const auto& graph : _graphs)
        for (osg::Texture* texture : graph.value->all())
            texture->resizeGLObjectBuffers(maximum);
}

void GeometryCache::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& lines : _outlines)
        lines.value->releaseGLObjects(state);
    for (const auto& graph : _graphs)
        for (osg::Texture* texture : graph.value->all())
            texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
