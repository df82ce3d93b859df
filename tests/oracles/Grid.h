#pragma once

#include "Field.h"

#include <osgVolumizer/core/voxels/VoxelType.h>

#include <glm/mat4x4.hpp>

namespace osgVolumizer {
namespace oracle {

/// Samples at the integer coordinates of the voxel frame, x fastest, interpolated between them.
/// Outside [0, N-1] the nearest sample on the border is taken.
class Grid : public Field
{
public:
    enum Interpolation
    {
        NEAREST,
        LINEAR,
        CUBIC ///< Keys's kernel, a = -1/2, per axis
    };

    /// Expects size.x * size.y * size.z samples, and at least one per axis.
    Grid(const glm::ivec3& size, std::vector<double> samples, Interpolation how = LINEAR);
    /// Samples of a field: sample (i,j,k) at gridToField * (i,j,k).
    Grid(const glm::ivec3& size, const Field& field, const glm::dmat4& gridToField,
         Interpolation how = LINEAR);

    const glm::ivec3& size() const { return _size; }
    const std::vector<double>& samples() const { return _samples; }
    double sample(int i, int j, int k) const
    {
        return _samples[std::size_t(i) +
                        std::size_t(_size.x) *
                            (std::size_t(j) + std::size_t(_size.y) * std::size_t(k))];
    }

    double value(const glm::dvec3& p) const override;
    /// Of the interpolant; 0 for NEAREST. Not for CUBIC.
    glm::dvec3 gradient(const glm::dvec3& p) const override;
    /// The faces of cells (LINEAR, CUBIC) or of voxels (NEAREST), and within a cell the roots of
    /// value(t) = v (LINEAR), or three places between (CUBIC).
    void appendBreaks(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1,
                      const std::vector<double>& values,
                      std::vector<double>& breaks) const override;

private:
    struct Cell;
    double cubicValue(const glm::dvec3& p) const;
    Cell cellAt(const glm::dvec3& p) const;

    glm::ivec3 _size;
    std::vector<double> _samples;
    Interpolation _interpolation;
};

/// Native bytes of voxels as doubles: data values, not normalised. Not for HALF.
std::vector<double> toDoubles(const void* voxels, std::size_t count, VoxelType type);
/// The other way round: rounded to nearest and clamped to what the type holds.
std::vector<unsigned char> fromDoubles(const std::vector<double>& values, VoxelType type);

} // namespace oracle
} // namespace osgVolumizer
