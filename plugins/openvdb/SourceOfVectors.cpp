#include "TreeSource.h"

namespace osgVolumizer {
namespace vdb {

namespace {

template <class Grid, class LengthType>
io::Source vectorsOf(const GridToShow& show, std::optional<int> component)
{
    using T = typename Grid::ValueType::value_type;
    switch (component.value_or(-1)) {
    case 0:
        return new TreeSource<Grid, Component<T, 0>>(show);
    case 1:
        return new TreeSource<Grid, Component<T, 1>>(show);
    case 2:
        return new TreeSource<Grid, Component<T, 2>>(show);
    default:
        return new TreeSource<Grid, Length<LengthType>>(show);
    }
}

} // namespace

io::Source sourceOfVectors(const GridToShow& show, std::optional<int> component)
{
    if (show.grid->isType<openvdb::Vec3SGrid>())
        return vectorsOf<openvdb::Vec3SGrid, float>(show, component);
    if (show.grid->isType<openvdb::Vec3DGrid>())
        return vectorsOf<openvdb::Vec3DGrid, double>(show, component);
    if (show.grid->isType<openvdb::Vec3IGrid>())
        return vectorsOf<openvdb::Vec3IGrid, float>(show, component);
    return nullptr;
}

} // namespace vdb
} // namespace osgVolumizer
