#pragma once

#include "Meshes.h"
#include "Volumes.h"

#include <support/Shapes.h>

#include <osg/MatrixTransform>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace test {

/// Translucent triangles of one colour (straight RGBA) in OSG's transparent bin.
inline osg::ref_ptr<osg::Geometry> makeGeometry(const Mesh& mesh, const glm::dvec4& color,
                                                bool opaque = false)
{
    osg::ref_ptr<osg::Geometry> geometry =
        support::makeQuad({}, osg::Vec4(color.r, color.g, color.b, color.a), !opaque);
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (const glm::vec3& p : mesh.points)
        points->push_back(osg::Vec3(p.x, p.y, p.z));
    geometry->setVertexArray(points);
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const auto& t : mesh.triangles)
        indices->insert(indices->end(), t.begin(), t.end());
    geometry->setPrimitiveSet(0, indices);
    return geometry;
}

/// One description of volumes, translucent and opaque surfaces that makes both a graph for OSG and
/// a scene for the oracle.
class MixedScene
{
public:
    MixedScene() : _root(new osg::Group) {}

    osg::Group* root() const { return _root.get(); }
    const oracle::Scene& truth() const { return _truth; }
    const std::vector<osg::ref_ptr<VolumeAppearance>>& volumes() const { return _volumes; }

    VolumeAppearance& addVolume(Voxels* voxels, const Points& points,
                                const osg::Matrixd& placement = osg::Matrixd())
    {
        const TwinVolume twin = makeTwin(voxels, points);
        _root->addChild(placed(twin.node, placement));
        _volumes.push_back(twin.node);
        _truth.volumes.push_back(twin.oracle);
        _truth.volumes.back().objectToWorld = support::toGlm(placement);
        return *twin.node;
    }

    /// A volume of any other kind; the caller adds its truth.
    void adopt(VolumeAppearance& volume)
    {
        _root->addChild(&volume);
        _volumes.emplace_back(&volume);
    }

    osg::Geometry& addMesh(const Mesh& mesh, const glm::dvec4& color, bool opaque = false)
    {
        const osg::ref_ptr<osg::Geometry> geometry = makeGeometry(mesh, color, opaque);
        _root->addChild(geometry);
        addTruth(mesh, color, opaque);
        return *geometry;
    }
    osg::Geometry& addQuad(const std::array<glm::vec3, 4>& corners, const glm::dvec4& color,
                           bool opaque = false)
    {
        return addMesh(quadMesh(corners), color, opaque);
    }
    /// To the oracle's scene only.
    void addTruth(const Mesh& mesh, const glm::dvec4& color, bool opaque = false)
    {
        // As a float of GL's.
        _truth.addMesh(mesh.points, mesh.triangles, glm::dvec4(glm::vec4(color)), opaque);
    }
    oracle::Scene& truth() { return _truth; }

    /// Distance between samples, in voxels, of all volumes.
    void setPeriod(double voxels)
    {
        for (const auto& v : _volumes)
            v->setSamplingPeriod(osg::Vec3d(voxels, voxels, voxels));
    }
    /// Reverses the order of nodes.
    void reverse()
    {
        std::vector<osg::ref_ptr<osg::Node>> nodes;
        for (unsigned i = _root->getNumChildren(); i-- > 0;)
            nodes.emplace_back(_root->getChild(i));
        _root->removeChildren(0, _root->getNumChildren());
        for (const auto& node : nodes)
            _root->addChild(node);
    }

    static osg::ref_ptr<osg::Node> placed(osg::Node* node, const osg::Matrixd& placement)
    {
        if (placement.isIdentity()) return node;
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(placement);
        transform->addChild(node);
        return transform;
    }

private:
    osg::ref_ptr<osg::Group> _root;
    oracle::Scene _truth;
    std::vector<osg::ref_ptr<VolumeAppearance>> _volumes;
};

/// The oracle's camera; rays start at the near plane where OSG leaves that alone.
inline oracle::Camera cameraOf(const support::RenderOptions& options)
{
    oracle::Camera camera = support::oracleCamera(options);
    const osg::Matrixd& p = options.projection;
    if (!options.computeNearFar) camera.nearDepth = (p(3, 2) + p(3, 3)) / (p(2, 2) + p(2, 3));
    return camera;
}

/// A picture of a scene against the oracle.
struct Judged
{
    support::FloatImage picture, expected;
    support::Difference all;  ///< over covered pixels
    support::Difference away; ///< over those where rasterisers may not disagree
};

inline Judged judge(const MixedScene& scene, const support::RenderOptions& options,
                    const support::FloatImage& expected, const support::Mask& away)
{
    Judged j;
    j.picture = support::renderScene(scene.root(), options);
    j.expected = expected;
    // GL snaps vertices to a grid of 1/256 pixel: whom a pixel centre as near as that to an outline
    // belongs to is open.
    const support::Mask decided = support::coveredPixels(
        oracle::awayFromSilhouettes(scene.truth(), cameraOf(options), 1.0 / 128.0));
    j.all = support::compare(
        j.picture, j.expected,
        decided & (support::coveredPixels(j.picture) | support::coveredPixels(j.expected)));
    j.away = support::compare(j.picture, j.expected, away);
    return j;
}

inline Judged judge(const MixedScene& scene, const support::RenderOptions& options)
{
    const oracle::Camera camera = cameraOf(options);
    return judge(scene, options, oracle::render(scene.truth(), camera),
                 support::coveredPixels(oracle::awayFromSilhouettes(scene.truth(), camera)));
}

/// Picture, oracle and twenty times their difference, for people to look at.
inline void save(const Judged& j, const std::string& name)
{
    support::savePicture(j.picture, name);
    support::savePicture(j.expected, name + "_oracle");
    support::FloatImage difference = j.picture;
    for (std::size_t i = 0; i < difference.pixels.size(); ++i)
        difference.pixels[i] = glm::vec4(
            20.0f * glm::abs(glm::vec3(j.picture.pixels[i] - j.expected.pixels[i])), 1.0f);
    support::savePicture(difference, name + "_difference");
}

} // namespace test
} // namespace osgVolumizer
