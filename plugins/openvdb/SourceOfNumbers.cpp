#include "TreeSource.h"

namespace osgVolumizer {
namespace vdb {

namespace {

using openvdb::Int64Grid;

template <class Grid, class Out>
io::Source sourceAs(const GridToShow& show)
{
    return new TreeSource<Grid, Out>(show);
}

template <class Out>
bool holds(const std::pair<double, double>& range)
{
    return range.first >= double(std::numeric_limits<Out>::lowest()) &&
           range.second <= double(std::numeric_limits<Out>::max());
}

// The narrowest type that has all values; doubles where there is none.
io::Source sourceOfLongs(const GridToShow& show)
{
    const io::Source doubles = sourceAs<Int64Grid, double>(show);
    const auto range = doubles->valueRange({glm::ivec3(0), show.description.size});
    if (!range) return doubles;
    if (holds<std::uint8_t>(*range)) return sourceAs<Int64Grid, std::uint8_t>(show);
    if (holds<std::int8_t>(*range)) return sourceAs<Int64Grid, std::int8_t>(show);
    if (holds<std::uint16_t>(*range)) return sourceAs<Int64Grid, std::uint16_t>(show);
    if (holds<std::int16_t>(*range)) return sourceAs<Int64Grid, std::int16_t>(show);
    if (holds<std::uint32_t>(*range)) return sourceAs<Int64Grid, std::uint32_t>(show);
    if (holds<std::int32_t>(*range)) return sourceAs<Int64Grid, std::int32_t>(show);
    return doubles;
}

} // namespace

io::Source sourceOfNumbers(const GridToShow& show)
{
    const bool half = show.grid->saveFloatAsHalf();
    if (show.grid->isType<openvdb::FloatGrid>())
        return half ? sourceAs<openvdb::FloatGrid, HalfSample>(show)
                    : sourceAs<openvdb::FloatGrid, float>(show);
    if (show.grid->isType<openvdb::DoubleGrid>())
        return half ? sourceAs<openvdb::DoubleGrid, HalfSample>(show)
                    : sourceAs<openvdb::DoubleGrid, double>(show);
    if (show.grid->isType<openvdb::BoolGrid>())
        return sourceAs<openvdb::BoolGrid, std::uint8_t>(show);
    if (show.grid->isType<openvdb::MaskGrid>())
        return sourceAs<openvdb::MaskGrid, std::uint8_t>(show);
    if (show.grid->isType<openvdb::Int32Grid>())
        return sourceAs<openvdb::Int32Grid, std::int32_t>(show);
    if (show.grid->isType<Int64Grid>()) return sourceOfLongs(show);
    return nullptr;
}

} // namespace vdb
} // namespace osgVolumizer
