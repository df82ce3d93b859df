#include "GeometryCache.h"

#include "../../Outlines.h"
#include "../../VolumeGeometry.h"
#include "../../Voxels.h"
#include "../../private/FieldShaders.h"
#include "SliceCache.h"

#include "../context/ReportOnce.h"

namespace osgVolumizer {
namespace render {

namespace {

std::vector<osg::TextureBuffer*> texturesOf(const std::shared_ptr<const TetraTextures>& textures)
{
    return textures ? textures->all() : std::vector<osg::TextureBuffer*>();
}

} // namespace

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

std::shared_ptr<const TetraTextures>
GeometryCache::tetrahedra(const VolumeGeometry& geometry,
                          const std::shared_ptr<const PreparedGeometry>& prepared)
{
    std::unique_lock<std::mutex> lock(_mutex);
    const auto* known = _graphs.find(prepared);
    const bool isNew = !known;
    auto textures = known ? *known : makeTetraTextures(prepared->tetras, !prepared->voxelFrame);
    const bool hasAll = !textures || !prepared->scalars ||
                        (textures->scalars && textures->scalarCount == geometry.getScalarCount());
    if (!hasAll) textures = withScalars(*textures, geometry);
    if (isNew || !hasAll) _graphs.add(prepared, textures);
    lock.unlock(); // an error handler may ask for anything
    const std::string name = "VolumeGeometry \"" + geometry.getName() + "\": ";
    if (!textures)
        reportOnce(
            {ErrorCode::TOO_LARGE, name + "there are too many tetrahedra; they are not drawn"});
    else if (isNew && textures->isOdd)
        reportOnce({ErrorCode::VALUE_INVALID, name + textures->oddities});
    return textures;
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
        for (osg::Texture* texture : texturesOf(graph.value))
            texture->resizeGLObjectBuffers(maximum);
}

void GeometryCache::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& lines : _outlines)
        lines.value->releaseGLObjects(state);
    for (const auto& graph : _graphs)
        for (osg::Texture* texture : texturesOf(graph.value))
            texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
