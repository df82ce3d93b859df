#include "Objects.h"
#include "RecordProperty.h"

#include <osgVolumizer/VolumeCut.h>

namespace osgVolumizer {
namespace serializers {
namespace {

const char* const kindNames[] = {
    "HALF_SPACE",         "BOX",         "SPHERE",         "SURFACE",
    "OUTSIDE_HALF_SPACE", "OUTSIDE_BOX", "OUTSIDE_SPHERE", "OUTSIDE_SURFACE"};
constexpr int kindsOfInsides = 4;

bool isMask(const CutRegion& region)
{
    return region.getKind() == CutRegion::MASK;
}

std::string regionName(unsigned number)
{
    return "Region" + std::to_string(number);
}

Field::Doubles numbersOf(const CutRegion& region)
{
    const osg::Vec4d& p = region.getPlane();
    const osg::BoundingBoxd& b = region.getBox();
    const osg::Vec3d& c = region.getCenter();
    switch (region.getKind()) {
    case CutRegion::HALF_SPACE:
        return {p.x(), p.y(), p.z(), p.w()};
    case CutRegion::BOX:
        return {b.xMin(), b.yMin(), b.zMin(), b.xMax(), b.yMax(), b.zMax()};
    case CutRegion::SPHERE:
        return {c.x(), c.y(), c.z(), region.getRadius()};
    case CutRegion::MASK:
    case CutRegion::SURFACE:
        break;
    }
    Field::Doubles vertices;
    for (const glm::dvec3& v : region.getMesh()->vertices)
        vertices.insert(vertices.end(), {v.x, v.y, v.z});
    return vertices;
}

void fillRegions(const VolumeCut& cut, Record& record, const osgDB::OutputStream&)
{
    record.add("Softness", Field::Doubles{cut.getSoftness()});
    record.add("Resolution", Field::Integers{cut.getResolution()});
    unsigned count = 0;
    for (unsigned i = 0; i < cut.getNumRegions(); ++i) {
        const CutRegion& region = cut.getRegion(i);
        if (isMask(region)) continue;
        const std::string name = regionName(count++);
        const int kind = region.getKind() + (region.isComplement() ? kindsOfInsides : 0);
        record.add(name, std::string(kindNames[kind]));
        record.add(name + "Numbers", numbersOf(region), 6);
        if (region.getKind() == CutRegion::SURFACE)
            record.add(name + "Triangles", region.getMesh()->indices, 9);
    }
    record.add("RegionCount", Field::Integers{count});
    Field::Doubles masks;
    for (unsigned i = 0; i < cut.getNumRegions(); ++i) {
        const CutRegion& region = cut.getRegion(i);
        if (isMask(region))
            masks.insert(masks.end(), {region.isComplement() ? 1.0 : 0.0, region.getMaskLow(),
                                       region.getMaskHigh()});
    }
    if (!masks.empty()) record.add("Masks", masks, 3); // outside, low, high
}

Status readRegion(Record& record, unsigned number, CutRegion& region)
{
    const std::string name = regionName(number);
    int kind = 0;
    Status status = record.getChoice(name, kindNames, 2 * kindsOfInsides, kind);
    Field::Doubles v;
    if (status.ok()) status = record.take(name + "Numbers", v);
    if (!status.ok()) return status;
    static const std::size_t counts[] = {4, 6, 4, 0};
    const int inside = kind % kindsOfInsides;
    const bool surface = inside == CutRegion::SURFACE;
    if (surface ? v.size() % 3 != 0 : v.size() != counts[inside])
        return {ErrorCode::SIZE_MISMATCH,
                "field " + name + "Numbers has " + std::to_string(v.size()) + " values"};
    core::TriangleMesh mesh;
    if (surface) {
        status = record.take(name + "Triangles", mesh.indices);
        if (!status.ok()) return status;
        for (std::size_t i = 0; i < v.size(); i += 3)
            mesh.vertices.emplace_back(v[i], v[i + 1], v[i + 2]);
    }
    switch (inside) {
    case CutRegion::HALF_SPACE:
        region = CutRegion::halfSpace({v[0], v[1], v[2], v[3]});
        break;
    case CutRegion::BOX:
        region = CutRegion::box({v[0], v[1], v[2], v[3], v[4], v[5]});
        break;
    case CutRegion::SPHERE:
        region = CutRegion::sphere({v[0], v[1], v[2]}, v[3]);
        break;
    default:
        region = CutRegion::surface(mesh);
    }
    if (kind >= kindsOfInsides) region = region.complement();
    return Status();
}

// Of the cut that is read: their voxels follow.
thread_local std::vector<CutRegion> masksToCome;

Status applyRegions(Record& record, const osgDB::Options*, VolumeCut& cut)
{
    masksToCome.clear();
    if (Field::Doubles masks; record.has("Masks") && record.take("Masks", masks).ok())
        for (std::size_t m = 0; m + 2 < masks.size(); m += 3) {
            const CutRegion mask = CutRegion::mask(nullptr, masks[m + 1], masks[m + 2]);
            masksToCome.push_back(masks[m] != 0.0 ? mask.complement() : mask);
        }
    Field::Doubles softness;
    int resolution = 0, count = 0;
    Status status = record.get("Softness", 1, softness);
    if (status.ok()) status = record.getInteger("Resolution", 0, 512, resolution);
    if (status.ok()) status = record.getInteger("RegionCount", 0, 1 << 16, count);
    if (status.ok()) status = cut.setSoftness(softness[0]);
    if (status.ok()) status = cut.setResolution(resolution);
    if (!status.ok()) return status;
    // Each by itself: one that is damaged is left out, and the first one is reported.
    for (int i = 0; i < count; ++i) {
        CutRegion region;
        Status read = readRegion(record, static_cast<unsigned>(i), region);
        if (read.ok()) read = cut.addRegion(region);
        if (status.ok()) status = read;
    }
    return status;
}

// Masks come last, whatever their numbers were.
bool checkMasks(const VolumeCut& cut)
{
    for (unsigned i = 0; i < cut.getNumRegions(); ++i)
        if (isMask(cut.getRegion(i))) return true;
    return false;
}

bool writeMasks(osgDB::OutputStream& os, const VolumeCut& cut)
{
    os << os.BEGIN_BRACKET << std::endl;
    for (unsigned i = 0; i < cut.getNumRegions(); ++i)
        if (isMask(cut.getRegion(i))) os.writeObject(cut.getRegion(i).getMask());
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readMasks(osgDB::InputStream& is, VolumeCut& cut)
{
    const std::vector<CutRegion> masks = std::move(masksToCome);
    masksToCome.clear();
    is >> is.BEGIN_BRACKET;
    for (const CutRegion& mask : masks) {
        const osg::ref_ptr<Voxels> voxels = is.readObjectOfType<Voxels>();
        if (is.getException()) break;
        const CutRegion region = CutRegion::mask(voxels, mask.getMaskLow(), mask.getMaskHigh());
        const CallerReports withName;
        reportReadError(is, cut, cut.addRegion(mask.isComplement() ? region.complement() : region));
    }
    is >> is.END_BRACKET;
    return true;
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_VolumeCut, new osgVolumizer::VolumeCut,
                        osgVolumizer::VolumeCut, "osg::Object osgVolumizer::VolumeCut")
{
    addRecordProperty<MyClass, &applyRegions, &fillRegions>(*wrapper, "Regions");
    ADD_USER_SERIALIZER(Masks);
}
