#pragma once

#include "VolumeMesh.h"
#include "VolumePart.h"

#include "../../core/sampling/View.h"

#include <osg/Drawable>
#include <osg/Program>

#include <memory>
#include <optional>

namespace osgVolumizer {
namespace render {

class CoarseImage;
class ComputeMarch;
struct PixelRays;

/// One leaf: a volume between two depths, drawn brick by brick, far to near. Made fresh for each
/// view and frame, and never changed afterwards.
class VolumeDrawable : public osg::Drawable
{
public:
    VolumeDrawable();
    osg::Object* cloneType() const override { return new VolumeDrawable; }
    osg::Object* clone(const osg::CopyOp&) const override { return new VolumeDrawable; }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "VolumeDrawable"; }

    void set(std::shared_ptr<const VolumeMesh> mesh, std::shared_ptr<const VolumePart> part)
    {
        _mesh = std::move(mesh);
        _part = std::move(part);
    }
    const VolumeMesh* mesh() const { return _mesh.get(); }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

private:
    void drawMarched(osg::RenderInfo& renderInfo, const osg::Program::PerContextProgram& program,
                     const PixelRays& rays, const core::View& view,
                     std::optional<CoarseImage>& image, ComputeMarch& compute) const;

    std::shared_ptr<const VolumeMesh> _mesh;
    std::shared_ptr<const VolumePart> _part;
};

} // namespace render
} // namespace osgVolumizer
