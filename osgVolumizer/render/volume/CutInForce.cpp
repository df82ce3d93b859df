#include "CutInForce.h"

#include "SettingsInForce.h"

#include "../../VolumeCut.h"
#include "../textures/BrickCells.h"
#include "../textures/CutTextures.h"

#include "../context/RenderDataAccess.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace osgVolumizer {
namespace render {

namespace {

// Frame, or of a deformed volume voxel coordinate, -> frame of cuts.
glm::dmat4 toCut(const PreparedGeometry& prepared, const Voxels* voxels)
{
    if (!voxels) return prepared.frameToObject;
    const core::Box3d unit = boxToCut(*voxels, {glm::dvec3(0.0), glm::dvec3(1.0)});
    return glm::scale(glm::translate(glm::dmat4(1.0), unit.min), unit.size());
}

bool hasExactPlanes(const PreparedGeometry& prepared, const core::Cut& cut, const Voxels* voxels)
{
    return (prepared.voxelFrame || !voxels) && !(cut.softness > 0.0);
}

} // namespace

core::Box3d cutBox(const PreparedGeometry& prepared, const Voxels* voxels)
{
    if (voxels) return boxToCut(*voxels, voxels->getLayout().extent());
    core::Box3d box;
    for (int i = 0; i < 8; ++i)
        box.expand(glm::dvec3(prepared.frameToObject * glm::dvec4(prepared.bounds.corner(i), 1.0)));
    return box;
}

std::shared_ptr<const core::Cut> cutInForce(const VolumeAppearance& appearance,
                                            const PreparedGeometry& prepared, bool anyPlanes)
{
    const VolumeCut* cut = appearance.getCut();
    if (!cut || cut->getNumRegions() == 0) return nullptr;
    const Voxels* voxels = voxelsIn(appearance, prepared);
    return cut->cutOf(cutBox(prepared, voxels), anyPlanes && (prepared.voxelFrame || !voxels));
}

std::vector<core::Plane> planesOfCut(const VolumeInstance& volume)
{
    const Voxels* voxels = voxelsIn(*volume.appearance, *volume.prepared);
    std::vector<core::Plane> planes;
    if (!volume.cut || !hasExactPlanes(*volume.prepared, *volume.cut, voxels)) return planes;
    const glm::dmat4 map = toCut(*volume.prepared, voxels);
    for (const core::Plane& p : volume.cut->planes) {
        core::Plane plane;
        plane.normal = glm::transpose(glm::dmat3(map)) * p.normal;
        plane.offset = p.distance(glm::dvec3(map[3]));
        const double length = glm::length(plane.normal);
        if (length > 0.0) planes.push_back({plane.normal / length, plane.offset / length});
    }
    return planes;
}

CutLook makeCutLook(const VolumeInstance& volume, const glm::dvec3& centerFrame,
                    ProgramFeatures& features, bool withPlanes)
{
    CutLook look;
    if (!volume.cut) return look;
    const core::Cut& cut = *volume.cut;
    const Voxels* voxels = voxelsIn(*volume.appearance, *volume.prepared);
    look.id = cut.id;
    look.fromVolume = toCut(*volume.prepared, voxels);
    // Far from the origin floats would lose it.
    const bool deformed = voxels && !volume.prepared->voxelFrame;
    const glm::dvec3 center = deformed ? cutBox(*volume.prepared, voxels).center()
                                       : glm::dvec3(look.fromVolume * glm::dvec4(centerFrame, 1.0));
    look.fromVolume[3] -= glm::dvec4(center, 0.0);
    if (withPlanes || !hasExactPlanes(*volume.prepared, cut, voxels))
        for (const core::Plane& p : cut.planes)
            look.planes.emplace_back(glm::dvec4(p.normal, p.distance(center)));
    for (const core::CutShape& shape : cut.shapes) {
        look.centers.emplace_back(glm::dvec4(shape.center - center, shape.radius));
        look.halfSizes.emplace_back(glm::dvec4(shape.halfSize, shape.keepInside ? 1.0 : -1.0));
    }
    look.sharpness = cut.softness > 0.0 ? static_cast<float>(1.0 / cut.softness) : 0.0f;
    if (cut.field) {
        look.field = renderData<CutTextures>(*volume.appearance->getCut())->get(cut.field);
        const glm::dvec3 count(cut.field->samples()), size = cut.field->box().size();
        look.fieldScale = glm::vec3((count - 1.0) / count / size);
        look.fieldOffset =
            glm::vec3((center - cut.field->box().min) * (count - 1.0) / count / size + 0.5 / count);
    }
    features.cutField = look.field.valid();
    features.cut = features.cutField || !look.planes.empty() || !look.centers.empty();
    return look;
}

} // namespace render
} // namespace osgVolumizer
