// Volumes bent by lattices, by code and by hand.
#include "Drags.h"
#include "PickOracle.h"

#include <osgVolumizer/interact/LatticeDragger.h>

#include <osg/MatrixTransform>

#include <support/GLTest.h>
#include <support/Reports.h>

namespace LatticeDraggerTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 25;
const osg::BoundingBoxd BOX(0, 0, 0, 24, 24, 24);
const osg::Vec3d MIDDLE(12, 12, 12);

RenderOptions view()
{
    return RenderOptions().size(160, 130).perspective(40.0).lookAt({40, -45, 42}, MIDDLE,
                                                                   {0, 0, 1});
}

osg::ref_ptr<VolumeAppearance> makeSliced()
{
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    volume->setLookupTable(makeTable(smoothPoints(0.3)));
    volume->setTechnique(VolumeAppearance::SLICES);
    return volume;
}

osg::ref_ptr<LatticeDeformer> latticeOf(VolumeAppearance& volume,
                                        const osg::Vec3i& points = {3, 3, 3},
                                        const osg::Vec3i& cells = {6, 6, 6})
{
    auto made =
        LatticeDeformer::create(&geometryBelow(volume), *volume.getVoxels(), BOX, points, cells);
    EXPECT_TRUE(made.ok()) << made.status.text;
    return *made;
}

std::vector<double> verticesOf(const LatticeDeformer& lattice)
{
    return lattice.getGeometry()->getTetraSet()->vertices.values();
}

class LatticePictures : public support::GLTest
{
};

} // namespace

TEST(LatticeDeformers, KeepVoxelCoordinates)
{
    const auto volume = makeSliced();
    ASSERT_TRUE(volume->getVoxels()->setSpacing({1, 2, 0.5}));
    ASSERT_TRUE(volume->getVoxels()->setOrigin({-3, 4, 5}));
    const auto lattice = latticeOf(*volume);
    const auto rest = lattice->getGeometry()->getTetraSet();
    ASSERT_TRUE(lattice->setPoint(lattice->numberOf(2, 2, 2), {30, 29, 28}));
    const auto bent = lattice->getGeometry()->getTetraSet();
    ASSERT_EQ(bent->vertices.size(), rest->vertices.size());
    EXPECT_EQ(bent->indices, rest->indices);
    double largest = 0.0;
    for (std::size_t i = 0; i < rest->vertices.size(); ++i) {
        EXPECT_EQ(bent->vertices.voxelCoordinate(i), rest->vertices.voxelCoordinate(i));
        const glm::dvec3 p = rest->vertices.position(i), q = bent->vertices.position(i);
        EXPECT_EQ(rest->vertices.voxelCoordinate(i),
                  (p - glm::dvec3(-3, 4, 5)) / glm::dvec3(1, 2, 0.5));
        const glm::dvec3 u = p / 24.0; // of three control points the last weighs u^2
        const double weight = std::pow(u.x * u.y * u.z, 2.0);
        EXPECT_LT(glm::length(q - p - weight * glm::dvec3(6, 5, 4)), 1e-12);
        largest = std::max(largest, glm::length(q - p));
    }
    // A corner is where its control point is.
    EXPECT_NEAR(largest, glm::length(glm::dvec3(6, 5, 4)), 1e-12);
    lattice->reset();
    EXPECT_EQ(verticesOf(*lattice), rest->vertices.values());
}

TEST(LatticeDeformers, RefuseToFoldOver)
{
    const support::Reports reports;
    const auto volume = makeSliced();
    const auto lattice = latticeOf(*volume);
    ASSERT_TRUE(lattice->setPoint(13, {14, 12, 11}));
    const std::vector<double> before = verticesOf(*lattice);
    const std::vector<osg::Vec3d> points = lattice->getPoints();
    const unsigned count = lattice->getModifiedCount();
    const ReportedStatus folded = lattice->setPoint(0, {40, 0, 0});
    EXPECT_EQ(folded.code, ErrorCode::VALUE_INVALID);
    EXPECT_GE(folded.index, 0);
    EXPECT_EQ(reports.count("folds over"), 1);
    EXPECT_EQ(lattice->setPoint(27, {1, 1, 1}).code, ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(lattice->setPoint(0, {NAN, 0, 0}).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(lattice->setPoints({}).code, ErrorCode::SIZE_MISMATCH);
    EXPECT_EQ(verticesOf(*lattice), before);
    EXPECT_EQ(lattice->getPoints(), points);
    EXPECT_EQ(lattice->getModifiedCount(), count);
    // None is made of a bad one, and the geometry stays.
    VolumeGeometry& geometry = geometryBelow(*volume);
    const unsigned modified = geometry.getModifiedCount();
    const Voxels& voxels = *volume->getVoxels();
    for (const auto& [n, cells, box] :
         {std::make_tuple(osg::Vec3i(1, 3, 3), osg::Vec3i(4, 4, 4), BOX),
          {osg::Vec3i(3, 3, 3), osg::Vec3i(4, 0, 4), BOX},
          {osg::Vec3i(3, 3, 3), osg::Vec3i(4, 4, 4), osg::BoundingBoxd(0, 0, 0, 1, 0, 1)},
          {osg::Vec3i(-5, 3, 3), osg::Vec3i(4, 4, 4), BOX}})
        EXPECT_EQ(LatticeDeformer::create(&geometry, voxels, box, n, cells).status.code,
                  ErrorCode::VALUE_INVALID);
    EXPECT_EQ(geometry.getModifiedCount(), modified);
}

TEST(LatticeDraggers, BendUndoAndRedo)
{
    const support::Reports reports;
    const auto volume = makeSliced();
    const auto lattice = latticeOf(*volume);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(volume);
    osg::ref_ptr<LatticeDragger> handles = new LatticeDragger(lattice);
    const osg::ref_ptr<DragHistory> history = new DragHistory;
    handles->setHistory(history);
    root->addChild(handles);
    osgViewer::Viewer viewer;
    lookWithoutWindow(viewer, root, view());
    Pointer pointer(viewer);
    const std::vector<double> rest = verticesOf(*lattice);
    // A corner, within the plane that faces the eye.
    const osg::Vec3d corner = lattice->getPoint(26);
    osg::Vec3d eye, center, up;
    view().view.getLookAt(eye, center, up);
    osg::Vec3d toEye = eye - center;
    toEye.normalize();
    const osg::Vec3d way = (osg::Vec3d(0, 0, 1) - toEye * toEye.z()) * 4.0;
    EXPECT_TRUE(pointer.dragFromTo(corner, corner + way));
    EXPECT_LT((lattice->getPoint(26) - corner - way).length(), 1e-2);
    // The one in the middle, through all of the volume.
    const osg::Vec3d inner = lattice->getPoint(13);
    EXPECT_TRUE(pointer.dragFromTo(inner, inner + way * 0.5));
    EXPECT_LT((lattice->getPoint(13) - inner - way * 0.5).length(), 1e-2);
    const std::vector<double> bent = verticesOf(*lattice);
    EXPECT_EQ(history->getUndoCount(), 2u);
    // A drag that would fold it over goes as far as it can: nowhere, by a command.
    osg::Vec3d far(-60, -60, -60);
    const double radius = handles->getDragger(26)->getMatrix()(0, 0);
    const osg::Vec3d before = lattice->getPoint(26);
    translate(*handles->getDragger(26), far / radius);
    EXPECT_EQ(lattice->getPoint(26), before);
    EXPECT_EQ(handles->getDragger(26)->getMatrix().getTrans(), before);
    EXPECT_EQ(reports.count("folds over"), 1);
    EXPECT_EQ(history->getUndoCount(), 2u);
    while (history->undo()) {
    }
    EXPECT_EQ(verticesOf(*lattice), rest);
    while (history->redo()) {
    }
    EXPECT_EQ(verticesOf(*lattice), bent);
    handles->follow();
    EXPECT_EQ(handles->getDragger(13)->getMatrix().getTrans(), lattice->getPoint(13));
}

TEST_F(LatticePictures, AtRestIsThePictureOfTheBox)
{
    const auto volume = makeSliced(), twin = makeSliced();
    latticeOf(*twin, {4, 3, 5}, {5, 6, 7});
    const FloatImage box = support::renderScene(volume, view());
    const FloatImage lattice = support::renderScene(twin, view());
    EXPECT_GT(support::coveredPixels(box, 0.1f).count(), 3000u);
    EXPECT_LT(support::compare(lattice, box).rmse, 1e-3);
    // Where a pixel lies on the very edge of a slice it may be taken for either side of it.
    int other = 0;
    for (std::size_t i = 0; i < box.pixels.size(); ++i)
        other += glm::length(lattice.pixels[i] - box.pixels[i]) > 1e-3f;
    EXPECT_LE(other, 10);
}

// A lattice whose points are turned shows what a transform that turns shows.
TEST_F(LatticePictures, ATurnIsThatOfATransform)
{
    const auto volume = makeSliced(), twin = makeSliced();
    const auto lattice = latticeOf(*twin, {3, 3, 3}, {4, 4, 4});
    const osg::Matrixd turn = osg::Matrixd::translate(-MIDDLE) *
                              osg::Matrixd::rotate(0.6, osg::Vec3d(1, -2, 3)) *
                              osg::Matrixd::translate(MIDDLE + osg::Vec3d(1, 2, -3));
    std::vector<osg::Vec3d> points;
    for (const osg::Vec3d& p : lattice->getPoints())
        points.push_back(p * turn);
    ASSERT_TRUE(lattice->setPoints(points));
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(turn);
    transform->addChild(volume);
    const FloatImage expected = support::renderScene(transform, view());
    const FloatImage bent = support::renderScene(twin, view());
    EXPECT_LT(support::compare(bent, expected).rmse, 2e-3);
    EXPECT_GT(support::compare(support::renderScene(volume, view()), expected).rmse, 5e-2);
}

TEST_F(LatticePictures, BendsWithItsHandles)
{
    const auto volume = makeSliced();
    const auto lattice = latticeOf(*volume, {3, 3, 3}, {8, 8, 8});
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            const unsigned n = lattice->numberOf(i, j, 2);
            ASSERT_TRUE(lattice->setPoint(n, lattice->getPoint(n) + osg::Vec3d(8, 2, 3)));
        }
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(volume);
    osg::ref_ptr<LatticeDragger> handles = new LatticeDragger(lattice);
    root->addChild(handles);
    const FloatImage picture = support::renderScene(root, view().size(400, 320));
    support::savePicture(picture, "handles_lattice");
    handles->setNodeMask(0);
    const FloatImage without = support::renderScene(root, view().size(400, 320));
    support::savePicture(without, "lattice_bent");
    EXPECT_GT(support::compare(picture, without).rmse, 1e-2);
}

} // namespace LatticeDraggerTest
