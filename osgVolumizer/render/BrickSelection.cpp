#include "BrickSelection.h"

#include <osgUtil/CullVisitor>

namespace osgVolumizer {
namespace render {

namespace {

osg::BoundingBox objectBounds(const core::Box3d& box, const glm::dmat4& frameToObject)
{
    osg::BoundingBox result;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 p = frameToObject * glm::dvec4(box.corner(i), 1.0);
        result.expandBy(osg::Vec3d(p.x, p.y, p.z));
    }
    return result;
}

} // namespace

void selectBricks(VolumeInstance& volume, const Voxels& voxels, const TableTexture& table,
                  osgUtil::CullVisitor& visitor)
{
    const core::BrickLayout& layout = voxels.getLayout();
    const osg::Vec2d range = voxels.getRange();
    const double toFraction = 1.0 / (range.y() - range.x());
    const osg::ref_ptr<BrickTextures> textures = BrickTextures::of(voxels);
    const PreparedGeometry& prepared = *volume.prepared;
    for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
        const core::BrickPlace place = layout.brick(i);
        core::Box3d box = place.clipBox;
        if (prepared.voxelFrame) {
            box = intersection(box, prepared.regionBox);
            if (box.empty()) continue;
            if (visitor.isCulled(objectBounds(box, prepared.frameToObject))) continue;
        }
        if (voxels.getComponents() == 1) {
            const auto values = voxels.getBrickRange(i);
            if (!(table.function->maximumOpacity((values.first - range.x()) * toFraction,
                                                 (values.second - range.x()) * toFraction) > 0.0))
                continue;
        }
        const BrickTexture texture =
            textures->get(voxels, i, volume.look->features.gradientTexture);
        if (!texture.texture) continue;
        const glm::vec3 size(place.samples.size());
        volume.bricks.push_back(
            {i, box, texture, 1.0f / size, (0.5f - glm::vec3(place.samples.min)) / size});
    }
}

} // namespace render
} // namespace osgVolumizer
