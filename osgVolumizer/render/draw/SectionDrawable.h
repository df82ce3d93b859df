#pragma once

#include "../../BrickDrawCallback.h"
#include "../context/LeafState.h"
#include "../textures/ColorPoints.h"
#include "CutLook.h"
#include "SectionMesh.h"
#include "SectionProgram.h"

#include <osg/Drawable>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A slice in one view of one frame. Immutable once made.
struct SectionPart
{
    SectionFeatures features;
    std::shared_ptr<const SectionMesh> mesh;
    std::vector<SelectedBrick> bricks; ///< as many as the mesh's; boxes are those it was cut at
    ColorPoints colors;
    glm::vec2 texelToFraction{1.0f, 0.0f}; ///< scale, offset
    /// From positions to voxel coordinates, where faces are drawn where they are in the volume.
    bool inPlace = true;
    glm::dvec3 positionScale{1.0}, positionOffset{0.0};
    glm::dmat4 toUsualClip{1.0};
    float thickness = 0.0f; ///< object units
    float period = 0.5f;    ///< voxels
    float opacity = 1.0f;
    bool usesTableOpacity = false;
    std::vector<glm::vec4> planes; ///< frame of positions; clip planes
    FogAbove fog;                  ///< with the feature
    CutLook cut;                   ///< with the feature
    float cutTolerance = 0.0f;     ///< object units outside that count as inside
    /// Draws instead, in the object frame; or null.
    osg::ref_ptr<const BrickDrawCallback> callback;
    osg::ref_ptr<const Voxels> voxels;
    osg::Matrixd objectToVoxel;
};

/// The leaf of a slice.
class SectionDrawable : public osg::Drawable
{
public:
    explicit SectionDrawable(std::shared_ptr<const SectionPart> part = nullptr,
                             const osg::BoundingBox& bounds = {});
    osg::Object* cloneType() const override { return new SectionDrawable; }
    osg::Object* clone(const osg::CopyOp&) const override { return new SectionDrawable; }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "SectionDrawable"; }

    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    void drawFaces(osg::RenderInfo& renderInfo) const;
    void callBack(osg::RenderInfo& renderInfo) const;

    std::shared_ptr<const SectionPart> _part;
};

} // namespace render
} // namespace osgVolumizer
