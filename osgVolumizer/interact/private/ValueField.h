#pragma once

#include "GridReader.h"
#include "PickLook.h"

#include "../../render/textures/TimeSteps.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace picking {

/// The values within one cell, as they are drawn: fractions of the range, or, where samples are
/// looked up before they are interpolated, extinctions per opacity unit.
struct CellValues
{
    VolumeAppearance::Interpolation interpolation = VolumeAppearance::LINEAR;
    double corner[64];
    bool valid = false; ///< else nothing is shown

    /// At a place in the cell, [0, 1] on each axis.
    double at(const glm::dvec3& place) const;
};

/// What the voxels of a volume are at each place of one level, at the time steps that are shown.
/// Places are in the grid frame of GridReader. For one thread.
class ValueField
{
public:
    ValueField(const Voxels& voxels, const PickLook& look, const render::TimeSteps& steps,
               int level);

    int level() const { return _level; }
    const GridReader& grid() const { return _first; }
    bool failed() const { return _first.failed() || (_blended && _second.failed()); }
    /// Samples lie at the corners of cells, or, for NEAREST, in their middle: what is added to a
    /// place before it is rounded down to its cell.
    double cellShift() const { return _look.interpolation == VolumeAppearance::NEAREST ? 0.5 : 0; }

    /// Tells from a range of fractions whether a part has to be looked into.
    using Shows = GridReader::Shows;
    GridReader::Part partAt(const glm::ivec3& cell, const Shows& shows);
    /// The values in a cell, as the look has them.
    CellValues cellValues(const glm::ivec3& cell);
    /// The same without a look: a component in data units, at a place.
    double dataAt(const glm::dvec3& place, int component);
    /// Colour at a place, straight, and opacity of a layer one unit thick, with vertices' colour.
    glm::dvec4 colorAt(const glm::dvec3& place, const glm::dvec4& vertexColor);
    /// The change of the data, or of the opacity of RGBA voxels, per sample, by central
    /// differences.
    glm::dvec3 gradientAt(const glm::dvec3& place);
    double rawSample(const glm::ivec3& place, int component);

private:
    core::ValueRange fractions(const core::ValueRange& range) const;
    bool fetch(const glm::ivec3& cell, int component, double* values);
    glm::dvec4 emissionAt(const glm::dvec3& place);
    int sampleCount() const;
    int significantComponent() const { return _look.rgba ? 3 : 0; }

    const PickLook& _look;
    int _level;
    GridReader _first, _second; // the second is used only where steps are blended
    bool _blended;
    double _fraction; // of the second
};

} // namespace picking
} // namespace osgVolumizer
