#pragma once

namespace osgUtil {
class IntersectionVisitor;
}

namespace osgVolumizer {

class VolumeGeometry;

/// What VolumeGeometry asks of whatever picks it, so that it need not know it. Every method may be
/// called from several threads.
class Picker
{
public:
    virtual ~Picker() = default;

    /// Adds what is seen of a volume to the visitor's intersections. `simulationTime`: seconds, of
    /// the frame that is seen.
    virtual void intersect(VolumeGeometry& geometry, osgUtil::IntersectionVisitor& visitor,
                           double simulationTime) = 0;
};

/// Sets the picker of the process, which has to outlive all nodes. Called while the library is
/// loaded, before there are threads.
void setPicker(Picker* picker);
/// Null where none was set: nothing is picked.
Picker* getPicker();

} // namespace osgVolumizer
