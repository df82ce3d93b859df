#pragma once

#include "DrawnBrick.h"
#include "LeafState.h"
#include "Paint.h"
#include "SceneLights.h"
#include "TableTextures.h"
#include "VolumeProgram.h"

#include "../core/sampling/Polygonize.h"

#include <osg/Drawable>
#include <osg/Texture2D>
#include <osg/Texture3D>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

struct BrickCells;
struct JoinedBricks;

/// What is drawn from one brick: a run of triangles, and the place of the brick.
struct BrickBatch
{
    DrawnBrick brick;                                  ///< none without voxels, and where joined
    std::shared_ptr<const JoinedBricks> joined;        ///< several bricks in one texture; else null
    std::shared_ptr<const BrickCells> cells;           ///< null where nothing is known
    glm::vec3 clipMin{0.0f}, clipMax{0.0f};            ///< frame; of what is drawn
    glm::vec3 brickMin{0.0f}, brickMax{0.0f};          ///< frame; of what the texture has
    glm::vec3 textureScale{1.0f}, textureOffset{0.0f}; ///< voxel -> texture coordinate
    unsigned firstIndex = 0, indexCount = 0;
};

/// Triangles far to near, by brick. Immutable once made.
struct VolumeMesh
{
    int stride = 3; ///< floats a vertex
    int slabOffset = -1, voxelCoordinateOffset = -1, colorOffset = -1, colorSize = 0;
    int spacingOffset = -1; ///< slices with a thickness each; else all have VolumeLook::step
    int positionOffset = 0;
    std::vector<float> vertices;
    std::vector<unsigned> indices;
    std::vector<BrickBatch> batches;
    unsigned faceCount = 0;
    /// A mesh that is kept from frame to frame, whose vertices and indices these are; or null.
    std::shared_ptr<const VolumeMesh> arrays;

    const std::vector<float>& vertexArray() const { return arrays ? arrays->vertices : vertices; }
    const std::vector<unsigned>& indexArray() const { return arrays ? arrays->indices : indices; }
};

/// All that a volume's fragments are shaded with, besides brick and view.
struct VolumeLook
{
    ProgramFeatures features;
    TableTexture table;
    glm::vec2 valueToEntry{1.0f, 0.0f}; ///< scale and offset: texel -> entry of the table
    double texelToFraction = 1.0;       ///< scale of texels to fractions of the range
    float isoTexel = 0.0f;
    glm::vec4 material{0.0f};             ///< ambient, diffuse, specular, shininess
    glm::vec2 gradientDecode{1.0f, 0.0f}; ///< scale, offset: gradient texture -> texels per voxel
    std::vector<EyeLight> lights;         ///< of the stage; some may be off
    StateAbove above;
    glm::dmat3 frameToUnits{1.0};   ///< frame vector -> opacity units
    glm::dvec3 center{0.0};         ///< frame; the middle of the volume
    double referenceDepth = 0.0;    ///< eye units; depths of slabs are counted from here
    double step = 1.0;              ///< between samples or slices: depth, distance or frame units
    double voxelsPerSample = 1.0;   ///< along the view axis
    glm::dvec3 surfaceNormal{0.0};  ///< slices: frame units; along which `step` is counted
    bool inFrontOfLayer = false;    ///< slabs: which part of a segment split by surfaces
    glm::vec2 surfaceWeights{0.0f}; ///< captured surfaces: 1 if colour, alpha is weighted by alpha
    int rank = 0;                   ///< slabs: between which ranks of surfaces
    std::vector<glm::ivec4> scissors; ///< window rectangles to draw in; none: everywhere
    int maximumSteps = 1;
    glm::vec3 regionMin{0.0f}, regionMax{0.0f}; ///< slabs: box of the whole volume (frame)
    /// Slabs: part of a pixel, in the frame. Faces are this much larger than what they stand for:
    /// which pixels a segment covers is for the shader to say, whose answer does not depend on how
    /// GL rounds vertices or whom it gives the pixels on an edge.
    glm::dvec3 pixelMargin{0.0};
    std::vector<Paint> paints;
    std::vector<glm::vec4> planes; ///< the region's half-spaces (frame)
};

/// One leaf: a volume between two depths, drawn brick by brick, far to near. Made fresh for each
/// view and frame, and never changed afterwards.
class VolumeDrawable : public osg::Drawable
{
public:
    VolumeDrawable();
    osg::Object* cloneType() const override { return new VolumeDrawable; }
    osg::Object* clone(const osg::CopyOp&) const override { return new VolumeDrawable; }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "VolumeDrawable"; }

    void set(std::shared_ptr<const VolumeMesh> mesh, std::shared_ptr<const VolumeLook> look)
    {
        _mesh = std::move(mesh);
        _look = std::move(look);
    }
    const VolumeMesh* mesh() const { return _mesh.get(); }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    std::shared_ptr<const VolumeMesh> _mesh;
    std::shared_ptr<const VolumeLook> _look;
};

} // namespace render
} // namespace osgVolumizer
