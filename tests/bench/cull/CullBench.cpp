// What a volume costs the cull traversal: outside the view, smaller than a pixel, and drawn.
// Microseconds a volume, of a thousand that share one set of voxels, less what the same traversal
// takes without them; medians over frames.
//
//   cullbench [frames]

#include "../support/Median.h"
#include "Volumes.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <osg/MatrixTransform>
#include <osg/Timer>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int COUNT = 1000;

// Cull and sort, as osgViewer's renderer does both, microseconds.
double cullMicroseconds(osg::Node& scene, int frames)
{
    osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> viewport = new osg::Viewport(0, 0, 512, 512);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(viewport);
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    visitor->getRenderInfo().pushCamera(camera);
    visitor->setFrameStamp(stamp);
    visitor->setSmallFeatureCullingPixelSize(0.0f); // what we do ourselves
    visitor->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    const osg::ref_ptr<osg::RefMatrix> projection =
        new osg::RefMatrix(osg::Matrixd::perspective(30.0, 1.0, 1.0, 1e7));
    const osg::ref_ptr<osg::RefMatrix> view = new osg::RefMatrix(
        osg::Matrixd::lookAt(osg::Vec3d(0, -300, 0), osg::Vec3d(), osg::Vec3d(0, 0, 1)));
    std::vector<double> times;
    for (int i = 0; i < frames; ++i) {
        stamp->setFrameNumber(static_cast<unsigned>(i));
        const osg::Timer_t start = osg::Timer::instance()->tick();
        graph->clean();
        stage->reset();
        stage->setViewport(viewport);
        visitor->reset();
        visitor->setStateGraph(graph);
        visitor->setRenderStage(stage);
        visitor->pushViewport(viewport);
        visitor->pushProjectionMatrix(projection);
        visitor->pushModelViewMatrix(view, osg::Transform::ABSOLUTE_RF);
        scene.accept(*visitor);
        visitor->popModelViewMatrix();
        visitor->popProjectionMatrix();
        visitor->popViewport();
        stage->sort();
        graph->prune();
        times.push_back(osg::Timer::instance()->delta_u(start, osg::Timer::instance()->tick()));
    }
    return bench::median(times);
}

// The volumes, each moved to one place.
osg::ref_ptr<osg::Group> makeScene(Voxels& voxels, int count, const osg::Vec3d& place, bool volumes)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->setCullingActive(false);
    for (int i = 0; i < count; ++i) {
        osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::translate(place));
        // As if each were alone: no group above decides for all.
        transform->setCullingActive(false);
        if (volumes) {
            const osg::ref_ptr<VolumeAppearance> volume = makeVolume(&voxels);
            volume->setLookupTable(makeTable(smoothPoints(0.1)));
            volume->setCullingActive(false);
            transform->addChild(volume);
        }
        scene->addChild(transform);
    }
    return scene;
}

void run(const char* name, Voxels& voxels, int count, const osg::Vec3d& place, int frames)
{
    const double with = cullMicroseconds(*makeScene(voxels, count, place, true), frames);
    const double without = cullMicroseconds(*makeScene(voxels, count, place, false), frames);
    std::printf("%-42s %8.2f us\n", name, (with - without) / count);
}

// A million bricks of 64^3 voxels, and coarser ones; all of one value, which has to be read.
class LargeSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, LargeSource);
    LargeSource() = default;
    LargeSource(const LargeSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op)
    {
    }
    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(6400);
        d.spacing = glm::dvec3(0.02);
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readLevel(0, region, destination);
    }
    int levelCount() const override { return core::BrickTree::levelsFor(glm::ivec3(6400), 64); }
    Status readLevel(int, const core::Box3i& region, void* destination) const override
    {
        std::memset(destination, 100, std::size_t(core::sampleCount(region.size())));
        return {};
    }
};

} // namespace

int main(int argc, char** argv)
{
    const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 101;
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), bumps);
    voxels->setBrickSize({9, 9, 9});
    run("outside the view", *voxels, COUNT, {5000, 0, 0}, frames);
    run("smaller than a pixel", *voxels, COUNT, {0, 1e6, 0}, frames);
    run("64 bricks, drawn one by one", *voxels, 1, {-16, -16, -16}, frames);
    const osg::ref_ptr<Voxels> large = new Voxels(new LargeSource);
    run("a million bricks of 64^3, paged", *large, 1, {-64, -64, -64}, frames);
    run("a million bricks, from within", *large, 1, {-64, -364, -64}, frames);
}
