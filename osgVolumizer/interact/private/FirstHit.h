#pragma once

#include "CellWalk.h"

#include <vector>

namespace osgVolumizer {
namespace picking {

/// What is seen of a volume along a segment.
struct SeenPlace
{
    bool found = false;
    double parameter = 0.0; ///< of the segment
    Span span;              ///< that it is in
};

/// Opacity units along a segment, per unit of its parameter.
double unitsPerParameter(const Segment& segment, const PickLook& look);

/// The optical depth (-ln of what passes) of a part of a span, between two of its parameters; it
/// ends where `enough` is reached, and `reached` is where. Its error is that of taking values to
/// run linearly over an eighth of a sample; steps of the table are met exactly.
double opticalDepth(ValueField& field, const PickLook& look, const Span& span, double units,
                    double enough, double& reached);
/// The same without voxels: of vertices' colours.
double opticalDepth(const PickLook& look, const Span& span, double units, double enough,
                    double& reached);

/// Where a user sees the volume, by its ray function; see interact/Pick.h. `field` is null where
/// there are no voxels.
SeenPlace findSeenPlace(ValueField* field, const PickLook& look, const std::vector<Span>& spans,
                        double unitsPerParameter, double opacity);

} // namespace picking
} // namespace osgVolumizer
