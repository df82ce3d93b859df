#pragma once

#include "../Export.h"
#include "../transfer/ExtinctionTable.h"
#include "../transfer/IntervalTable.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// The value at a position of the voxel frame, as a fraction of the voxels' range; NaN where
/// nothing shows.
using FractionField = std::function<double(const glm::dvec3& positionVoxel)>;

/// The derivative of that with respect to the position, per voxel.
using GradientField = std::function<glm::dvec3(const glm::dvec3& positionVoxel)>;

/// How points of a ray are lit, by one white light that is far away: as the renderer does it, see
/// render/draw/shaders/shading.glsl.
struct RayShading
{
    double ambient = 0.2, diffuse = 0.8, specular = 0.3, shininess = 32.0;

    /// \param gradient in ranges per opacity unit; \param toLight, toEye unit vectors of its frame
    OSGVOLUMIZER_CORE_EXPORT glm::dvec3 shade(const glm::dvec3& color, const glm::dvec3& gradient,
                                              const glm::dvec3& toLight,
                                              const glm::dvec3& toEye) const;
};

/// Where a ray goes, and what it is lit by.
struct RayPath
{
    glm::dvec3 beginVoxel, endVoxel; ///< voxel frame; these differ
    glm::dmat3 voxelToUnits{1.0};    ///< a vector of the voxel frame -> opacity units
    glm::dvec3 toLight{0.0};         ///< opacity units, of length 1; where it is lit
};

/// What rays are integrated for.
struct RayIntegration
{
    double opaqueEnough = 0.0;           ///< what is left of the light where they end
    const RayShading* shading = nullptr; ///< null: not lit. Expects rays with gradients
    /// Raised by the number of steps or pieces that are tried between two distances along the ray.
    std::size_t* tried = nullptr;
    glm::dvec2 betweenVoxel{0.0};
};

/// A ray through voxels that are interpolated linearly: in each of the cells between samples that
/// it passes, its value is a cubic polynomial, so that four values a cell say all there is to know
/// of it; or through voxels of which the nearest counts, one value a cell about each. So it is with
/// gradients that are interpolated linearly, too.
class OSGVOLUMIZER_CORE_EXPORT CellRay
{
public:
    /// Asks the fields three times a cell, or with `nearest` once. Without a gradient it cannot be
    /// lit.
    CellRay(const RayPath& path, const FractionField& field, const GradientField& gradient,
            bool nearest);

    double lengthVoxel() const { return _ends.back(); }
    std::size_t cellCount() const { return _ends.size(); }

    /// Premultiplied colour and opacity, composited from about equal steps, as the renderer does
    /// it: each takes the table's entry at its middle, or with integrals the mean over the values
    /// between its ends. The midpoint rule is of second order.
    glm::dvec4 integrate(const ExtinctionTable& table, double periodVoxel,
                         const RayIntegration& options) const;
    /// The same from runs whose length adapts to the light that they give, see AdaptiveStep.
    /// Expects a table with integrals.
    glm::dvec4 integrateAdaptively(const ExtinctionTable& table, double periodVoxel,
                                   const RayIntegration& options) const;
    /// The same from pieces that end at faces of cells and where the value turns round or passes a
    /// corner of the table, and are no longer than `longestVoxel`, nor than what lets half of the
    /// light through. Each takes two samples: see lightOfPiece().
    glm::dvec4 integrate(const IntervalTable& table, double longestVoxel,
                         const RayIntegration& options) const;

    /// From the first to the last place that shows something, voxels along the ray; the same twice
    /// where nothing does.
    glm::dvec2 shownPart(const IntervalTable& table) const;

private:
    struct Gradients // of a cell, per component, at the places of its values
    {
        glm::vec4 x, y, z;
    };
    class Walk;

    template <class Visit>
    void visitPieces(const IntervalTable& table, double longestVoxel, const Visit& visit) const;
    double cellBegin(std::size_t cell) const { return cell > 0 ? _ends[cell - 1] : 0.0; }
    glm::dvec3 gradient(std::size_t cell, double s) const;
    glm::dvec4 lit(const glm::dvec4& color, std::size_t cell, double s,
                   const RayIntegration& options) const;

    std::vector<double> _ends;         ///< of cells, from the ray's beginning, voxels
    std::vector<glm::vec4> _values;    ///< at 0, 1/3, 2/3 and 1 of each cell
    std::vector<Gradients> _gradients; ///< ranges per opacity unit; none where it is not lit
    double _unitsPerVoxel;
    glm::dvec3 _toEye, _toLight; ///< opacity units
    bool _nearest;               ///< values of cells have nothing to do with one another
};

/// Pieces may be longer than their bound by this factor, or rounding would cut slivers of a cell
/// that is just as long.
constexpr double PIECE_SLACK = 1.001;

/// Light of a piece of a ray, premultiplied colour and opacity, from colour and extinction (bits
/// per unit) at the two points of Gauss's rule, through which both are taken for linear. Where they
/// are smooth it is off by the fifth power of the length, so of fourth order along a ray.
OSGVOLUMIZER_CORE_EXPORT glm::dvec4 lightOfPiece(const glm::dvec4& first, const glm::dvec4& second,
                                                 double lengthUnits);

} // namespace core
} // namespace osgVolumizer
