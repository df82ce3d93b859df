#pragma once

#include "../../VolumeAppearance.h"

#include <cstdint>
#include <string>

namespace osgVolumizer {
namespace render {

/// What a volume's shader is told to do, or left out of it. Each has a row in ProgramFeatures.cpp,
/// which names what the shader finds defined.
struct ProgramFlags
{
    bool slab = true;              ///< march a segment per fragment, or shade one slice
    bool voxelCoordinates = false; ///< as a vertex attribute; else the frame is the voxel frame
    bool vertexColors = false;
    bool voxels = true; ///< a brick texture
    bool rgba = false;  ///< voxels are colours, not values to look up
    bool opaqueDepth = false;
    bool splitDepth = false; ///< surfaces split the segment; expects opaqueDepth
    bool ranked = false;    ///< the segment lies between two ranks of surfaces; expects opaqueDepth
    bool spherical = false; ///< slices are spheres about the eye
    bool exact = false;     ///< interpolate from fetched samples, in full precision
    bool nearest = false, cubic = false; ///< else linear
    bool before = false;                 ///< look samples up, then interpolate
    bool preIntegrated = false;          ///< look runs of values up
    bool shortRuns = false;              ///< look short runs up as single values
    bool adaptive = false;               ///< runs as long as the light that they give allows
    bool cells = false;                  ///< split rays at faces of cells and corners of the table
    bool corners = false;                ///< the table has some within its range
    bool smoothTable = false;            ///< interpolate between entries
    bool shading = false;
    bool gradientTexture = false; ///< brick textures hold gradients besides values
    bool skipping = false;        ///< leap over cells that show nothing
    bool countSamples = false;    ///< draw the number of samples: see ViewHooks
    bool coarse = false;          ///< fewer rays than pixels: see CoarseImage
    bool blendsSteps = false;     ///< values are those between two time steps
    bool fog = false;             ///< colours fade with depth
    bool cut = false;             ///< by a VolumeCut, more than planes can
    bool cutField = false;        ///< whose distances are those of a grid, too
    bool inOrder = false;         ///< of several that are marched: one after another, not together
    // Slabs of what is no convex region of voxels in one frame: rays walk through tetrahedra.
    bool tetrahedra = false;
    bool scalars = false, cellScalars = false; ///< of vertices or of tetrahedra, in place of voxels
    bool places = false;    ///< vertices have voxel coordinates: a deformed volume
    bool wholeRuns = false; ///< voxels in one frame: what is between outer faces is marched at once
};

/// What a volume's shader has to do; nothing that is not asked for is compiled in.
struct ProgramFeatures : ProgramFlags
{
    VolumeAppearance::RayFunction rayFunction = VolumeAppearance::COMPOSITE;
    /// Slots of captured surfaces that are composited while marching, over all pixels of an area;
    /// multiple of 4. Expects opaqueDepth, one brick, and the whole depth of the volume.
    int slotCount = 0;
    int paintCount = 0; ///< bricks of volumes that paint this one; no more than 4
    int planeCount = 0; ///< half-spaces that cut it, besides the clip box
    int filterBits = 0; ///< see ContextLimits; less than 16
    /// User values of vertices that a field shader of that number makes something of; tetrahedra
    /// only. 0: none.
    int fieldCount = 0, fieldShader = 0;

    /// Whether surfaces are sorted before the volume, whose shader reads them.
    bool needsSortedSurfaces() const { return ranked || slotCount > 0; }

    /// Whether light is integrated in closed form: along rays, colour and opacity are linear.
    bool isExact() const { return tetrahedra && !voxels && fieldCount == 0 && integratesLight(); }
    bool integratesLight() const;

    /// Whether the rays' values are gathered in a target of their own, and drawn at once, at one
    /// depth.
    bool gathers() const;

    /// Different for different features, but for those of fields.
    std::uint64_t key() const;
    /// Different for different field shaders and numbers of fields.
    std::uint64_t fieldKey() const
    {
        return static_cast<std::uint64_t>(fieldShader) << 8 |
               static_cast<std::uint64_t>(fieldCount);
    }

    /// The lines that define, for GLSL, all that is on.
    std::string defines() const;
};

} // namespace render
} // namespace osgVolumizer
