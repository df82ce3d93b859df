#include "PickLook.h"

#include "../../core/RecencyCache.h"
#include "../../render/textures/TexelFormat.h"
#include "../../render/volume/SettingsInForce.h"

#include <mutex>

namespace osgVolumizer {
namespace picking {

namespace {

using TablePtr = std::shared_ptr<const PickTable>;

/// Tables of all appearances: their integrals cost more than a pick.
class PickTables
{
public:
    TablePtr get(const LookupTable& table, const osg::Vec2d& range)
    {
        const Key key{table.getModifiedCount(), range};
        std::lock_guard<std::mutex> lock(_mutex);
        if (const TablePtr* known = _tables.find(key)) return *known;
        return _tables.add(key,
                           std::make_shared<const PickTable>(table.getNormalizedFunction(range)));
    }

private:
    struct Key
    {
        unsigned modifiedCount; // no two tables have had the same
        osg::Vec2d range;
        bool operator==(const Key& o) const
        {
            return modifiedCount == o.modifiedCount && range == o.range;
        }
    };
    std::mutex _mutex;
    core::RecencyCache<Key, TablePtr> _tables{16};
};

// Opacity as a function of itself.
TablePtr opacities()
{
    static const TablePtr table =
        std::make_shared<const PickTable>(std::make_shared<const core::TransferFunction>());
    return table;
}

// Of values in a range.
void setRange(const VolumeAppearance& appearance, const osg::Vec2d& range, PickLook& look)
{
    static PickTables tables;
    const double width = range.y() - range.x();
    look.scale = 1.0 / width;
    look.offset = -range.x() / width;
    look.isoFraction = look.fraction(appearance.getIsoValue());
    look.table = look.rgba ? opacities() : tables.get(*appearance.getLookupTable(), range);
}

void setValues(const VolumeAppearance& appearance, PickLook& look)
{
    const Voxels& voxels = *appearance.getVoxels();
    look.rgba = voxels.getComponents() == 4;
    setRange(appearance, voxels.getRange(), look);
    const render::TexelFormat format = render::texelFormat(voxels, false);
    if (!look.rgba || format.fraction) return;
    const double full = format.type == VoxelType::UINT8    ? 255.0
                        : format.type == VoxelType::UINT16 ? 65535.0
                                                           : 1.0;
    look.scale = 1.0 / full;
    look.offset = -render::lowestSigned(voxels.getType()) / full;
}

} // namespace

double PickLook::extinction(double fraction) const
{
    return core::extinctionFromOpacity(opacity(fraction));
}

double PickLook::meanExtinction(double from, double to) const
{
    return table->integral.mean(from, to).a;
}

PickLook makePickLook(const VolumeAppearance& appearance, const render::PreparedGeometry& prepared,
                      const osg::Vec2d& scalarRange)
{
    PickLook look;
    render::Reasons reasons; // a frame reports them
    look.opacityUnit = appearance.getEffectiveOpacityUnit();
    look.scalars = prepared.scalars;
    look.voxels = render::voxelsIn(appearance, prepared) != nullptr;
    look.table = opacities();
    look.plain = !look.voxels && !look.scalars && prepared.tetras.vertices.format().colorSize == 0;
    if (look.scalars) {
        look.rayFunction = render::usedRayFunction(appearance, prepared, reasons);
        setRange(appearance, scalarRange, look);
    }
    if (!look.voxels) return look;
    look.paints = appearance.getCombineRule() == VolumeAppearance::PAINT;
    look.rayFunction = render::usedRayFunction(appearance, prepared, reasons);
    look.interpolation = render::usedInterpolation(appearance, reasons);
    setValues(appearance, look);
    look.before = render::looksUpBefore(appearance, look.rayFunction, look.interpolation);
    return look;
}

} // namespace picking
} // namespace osgVolumizer
