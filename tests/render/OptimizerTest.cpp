// osgUtil's Optimizer, with each of its flags alone and with its sets of them, changes no picture
// of a volume.

#include "Volumes.h"

#include <support/GLTest.h>
#include <support/Instrumented.h>
#include <support/Shapes.h>

#include <osg/Geode>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/Switch>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgUtil/Optimizer>

namespace OptimizerTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using osgUtil::Optimizer;
using support::FloatImage;
using support::RenderOptions;

namespace {

std::vector<unsigned> optimizations()
{
    std::vector<unsigned> flags;
    for (unsigned bit = 0; bit < (support::INSTRUMENTED ? 0u : 22u); ++bit)
        flags.push_back(1u << bit);
    flags.insert(flags.end(),
                 {Optimizer::DEFAULT_OPTIMIZATIONS, Optimizer::ALL_OPTIMIZATIONS,
                  Optimizer::DEFAULT_OPTIMIZATIONS | Optimizer::ALL_OPTIMIZATIONS, (1u << 22) - 1});
    return flags;
}

osg::ref_ptr<osg::MatrixTransform> place(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->setDataVariance(osg::Object::STATIC);
    transform->addChild(child);
    return transform;
}

class OptimizerFlags : public support::GLTest
{
protected:
    using Maker = std::function<osg::ref_ptr<osg::Node>()>;

    // Renders what `make` makes, plain and optimized in each way; each time a fresh one.
    void expectSamePictures(const Maker& make, RenderOptions options)
    {
        options.size(96, 96);
        const osg::ref_ptr<osg::Node> plain = make();
        ASSERT_TRUE(plain.valid());
        options.frameScene(plain->getBound());
        const FloatImage expected = support::renderScene(plain, options);
        ASSERT_GT(support::coveredPixels(expected, 0.02f).count(), 500u);
        for (const unsigned flags : optimizations()) {
            const osg::ref_ptr<osg::Node> scene = make();
            for (int i = 0; i < 2; ++i) { // what was done once is there the second time
                Optimizer().optimize(scene, flags);
                const support::Difference c =
                    compare(support::renderScene(scene, options), expected);
                EXPECT_LT(c.maximum, 2e-3) << std::hex << flags << ", time " << i;
                EXPECT_LT(c.rmse, 1e-4) << std::hex << flags << ", time " << i;
            }
        }
    }
    static osg::ref_ptr<osg::Node> readScene(const std::string& name)
    {
        osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        const std::string folder = std::string(OSGVOLUMIZER_SOURCE_DIR) + "/data";
        options->getDatabasePathList().push_back(folder);
        return osgDB::readRefNodeFile(folder + "/" + name, options);
    }
};

TEST_F(OptimizerFlags, ScanReadFromAFile)
{
    expectSamePictures([] { return readScene("head.osgt"); }, RenderOptions());
}

TEST_F(OptimizerFlags, ScanAmongMeshesReadFromAFile)
{
    RenderOptions options;
    options.light = true;
    expectSamePictures([] { return readScene("mixed.osgt"); }, options);
}

// Geometry, appearance and voxels are shared, under static transforms above and between them.
osg::ref_ptr<osg::Node> sharedNodes()
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(9), bumps);
    const osg::ref_ptr<LookupTable> table = makeTable(smoothPoints(0.2));
    const osg::ref_ptr<VolumeGeometry> box = VolumeGeometry::createBox(*voxels);

    osg::ref_ptr<VolumeAppearance> pair = new VolumeAppearance;
    pair->setVoxels(voxels);
    pair->setLookupTable(table);
    pair->addChild(box);
    pair->addChild(
        place(osg::Matrixd::scale(0.5, 1.5, 0.7) * osg::Matrixd::translate(11, 0, 0), box));
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addChild(box);
    osg::ref_ptr<VolumeAppearance> other = new VolumeAppearance;
    other->setVoxels(voxels);
    other->addChild(place(osg::Matrixd::rotate(0.4, osg::Vec3d(1, 1, 0)), geode));

    osg::ref_ptr<osg::PositionAttitudeTransform> up = new osg::PositionAttitudeTransform;
    up->setDataVariance(osg::Object::STATIC);
    up->setPosition({0, 0, 13});
    up->addChild(pair);
    osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    choice->addChild(place(osg::Matrixd::rotate(0.5, osg::Vec3d(0, 0, 1)), pair), true);
    choice->addChild(place(osg::Matrixd::translate(3, 3, 3), pair), false);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(place(osg::Matrixd::scale(1.1, 0.9, 1.0), choice));
    scene->addChild(up);
    scene->addChild(place(osg::Matrixd::translate(-14, 0, 14), other));
    scene->addChild(
        place(osg::Matrixd::translate(-14, 0, 0),
              place(osg::Matrixd::scale(1, 1, -1) * osg::Matrixd::translate(0, 0, 8), other)));
    return scene;
}

TEST_F(OptimizerFlags, SharedNodesUnderStaticTransforms)
{
    expectSamePictures(sharedNodes, RenderOptions());
}

// What is drawn with a volume, below its appearance, stays where it is.
TEST_F(OptimizerFlags, MeshesBelowAnAppearance)
{
    expectSamePictures(
        [] {
            const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(9), bumps);
            osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
            volume->setLookupTable(makeTable(smoothPoints(0.2)));
            osg::ref_ptr<osg::Geode> geode = new osg::Geode;
            geode->addChild(support::makeQuad(
                {osg::Vec3(-1, 4, -1), {9, 4, -1}, {9, 4, 9}, {-1, 4, 9}}, {0.2f, 0.7f, 0.3f, 1}));
            volume->addChild(place(osg::Matrixd::rotate(0.3, osg::Vec3d(0, 0, 1)), geode));
            osg::ref_ptr<osg::Group> scene = new osg::Group;
            scene->addChild(place(osg::Matrixd::scale(2, 1, 1), volume));
            return osg::ref_ptr<osg::Node>(scene);
        },
        RenderOptions());
}

} // namespace

} // namespace OptimizerTest
