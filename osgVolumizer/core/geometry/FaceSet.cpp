#include "FaceSet.h"

namespace osgVolumizer {
namespace core {

void FaceSet::clear()
{
    vertices.clear();
    indices.clear();
    faceOffsets.assign(1, 0);
}

} // namespace core
} // namespace osgVolumizer
