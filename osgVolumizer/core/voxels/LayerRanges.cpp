#include "LayerRanges.h"

#include "VoxelDispatch.h"

#include <limits>
#include <type_traits>

namespace osgVolumizer {
namespace core {

namespace {

// Ranges over many rows, sample by sample, so that no comparison waits for the one before.
template <class C>
struct Rows
{
    static constexpr C LOWEST = std::numeric_limits<C>::lowest();
    static constexpr C HIGHEST = std::numeric_limits<C>::max();

    explicit Rows(std::size_t samples) : low(samples, HIGHEST), high(samples, LOWEST) {}

    template <class T>
    void add(const T* row, std::size_t stride)
    {
        for (std::size_t i = 0; i < low.size(); ++i) {
            const C v = static_cast<C>(row[i * stride]);
            const bool finite = v >= LOWEST && v <= HIGHEST; // false for NaN too
            low[i] = finite && v < low[i] ? v : low[i];
            high[i] = finite && v > high[i] ? v : high[i];
        }
    }
    ValueRange sample(std::size_t i) const
    {
        if (low[i] > high[i]) return {};
        return {static_cast<double>(low[i]), static_cast<double>(high[i])};
    }
    ValueRange all() const
    {
        ValueRange range;
        for (std::size_t i = 0; i < low.size(); ++i)
            range.expand(sample(i));
        return range;
    }

    std::vector<C> low, high;
};

} // namespace

LayerRanges scanLayers(const VoxelView& view, int component)
{
    LayerRanges result;
    if (sampleCount(view.size) == 0) return result;
    visitVoxelType(view.type, [&](auto tag) {
        using T = decltype(tag);
        using C = std::conditional_t<std::is_same<T, Half>::value, float, T>;
        const auto stride = static_cast<std::size_t>(view.components);
        const auto samples = static_cast<std::size_t>(view.size.x);
        const T* row = static_cast<const T*>(view.data) + component;
        std::vector<Rows<C>> byY(static_cast<std::size_t>(view.size.y), Rows<C>(samples));
        for (int z = 0; z < view.size.z; ++z) {
            Rows<C> layer(samples);
            for (Rows<C>& rows : byY) {
                layer.add(row, stride);
                rows.add(row, stride);
                row += samples * stride;
            }
            result.axis[2].push_back(layer.all());
        }
        result.axis[0].resize(samples);
        for (const Rows<C>& rows : byY) {
            result.axis[1].push_back(rows.all());
            for (std::size_t x = 0; x < samples; ++x)
                result.axis[0][x].expand(rows.sample(x));
        }
    });
    return result;
}

} // namespace core
} // namespace osgVolumizer
