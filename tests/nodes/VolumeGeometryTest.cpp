#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/Voxels.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/MatrixTransform>
#include <osgUtil/Optimizer>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <limits>
#include <thread>

namespace VolumeGeometryTest {

using namespace osgVolumizer;

namespace {

const osg::BoundingBoxd BOX(-1.0, 2.0, 3.0, 4.0, 5.0, 9.0);

double volumeOf(const core::TetraSet& set)
{
    double sum = 0.0;
    for (std::size_t t = 0; t < set.tetraCount(); ++t) {
        glm::dvec3 p[4];
        for (std::size_t i = 0; i < 4; ++i)
            p[i] = set.vertices.position(set.indices[4 * t + i]);
        sum += std::abs(glm::dot(p[1] - p[0], glm::cross(p[2] - p[0], p[3] - p[0]))) / 6.0;
    }
    return sum;
}

TEST(VolumeGeometry, BoxesAreFilledByTheirTetrahedra)
{
    const struct
    {
        VolumeGeometry::BoxTessellation how;
        std::size_t tetrahedra;
        double volumes; // of the box
    } expected[] = {{VolumeGeometry::FIVE, 5, 1.0},
                    {VolumeGeometry::TWENTY_FOUR, 24, 1.0},
                    {VolumeGeometry::ENCLOSING, 1, 27.0 / 6.0}};
    for (const auto& e : expected) {
        const auto set = VolumeGeometry::createBox(BOX, e.how)->getTetraSet();
        EXPECT_TRUE(set->validate());
        EXPECT_EQ(set->tetraCount(), e.tetrahedra);
        EXPECT_NEAR(volumeOf(*set), e.volumes * 5.0 * 3.0 * 6.0, 1e-11);
        const core::Box3d bounds = set->bounds();
        EXPECT_EQ(bounds.min, glm::dvec3(-1.0, 2.0, 3.0));
        if (e.how != VolumeGeometry::ENCLOSING) {
            EXPECT_EQ(bounds.max, glm::dvec3(4.0, 5.0, 9.0));
        }
    }
}

TEST(VolumeGeometry, TheBoxOfVoxelsGoesFromFirstToLastSample)
{
    VoxelSource::Description description;
    description.size = {5, 4, 3};
    description.spacing = {0.5, 1.0, 2.0};
    description.origin = {10.0, 20.0, 30.0};
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(description));
    const osg::ref_ptr<Voxels> voxels = new Voxels(source);
    const core::Box3d bounds = VolumeGeometry::createBox(*voxels)->getTetraSet()->bounds();
    EXPECT_EQ(bounds.min, glm::dvec3(10.0, 20.0, 30.0));
    EXPECT_EQ(bounds.max, glm::dvec3(12.0, 23.0, 34.0));
}

TEST(VolumeGeometry, BoundsHoldEveryVertexWhereverItIs)
{
    // OSG's bounds are floats: far away they must be rounded outwards.
    for (const double place : {0.0, 6.4e6 + 0.123456789, -1.7e9, 1e12}) {
        const osg::BoundingBoxd box(place, place, place, place + 0.1, place + 0.2, place + 0.3);
        const osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(box);
        const osg::BoundingBox bounds = geometry->getBoundingBox();
        const osg::BoundingSphere sphere = geometry->getBound();
        for (unsigned i = 0; i < 8; ++i) {
            const osg::Vec3d p = box.corner(i);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(double(bounds._min[axis]), p[axis]);
                EXPECT_GE(double(bounds._max[axis]), p[axis]);
            }
            EXPECT_LE((osg::Vec3d(sphere.center()) - p).length(), double(sphere.radius()));
        }
    }
    EXPECT_FALSE(osg::ref_ptr<VolumeGeometry>(new VolumeGeometry)->getBound().valid());
}

TEST(VolumeGeometry, ItsBoxIsKnownWhicheverBoundIsAskedForFirst)
{
    const osg::BoundingBoxd box(1, 2, 3, 4, 6, 8);
    const osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(box);
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(geometry->isCullingActive()); // asks for the sphere
        EXPECT_EQ(geometry->getBoundingBox()._min, osg::Vec3(1, 2, 3));
        EXPECT_EQ(geometry->getBoundingBox()._max, osg::Vec3(4, 6, 8));
        geometry->dirtyBound();
    }
}

TEST(VolumeGeometry, AVisitorSeesItLikeAnyDrawable)
{
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::translate(100.0, 0.0, 0.0));
    transform->addChild(VolumeGeometry::createBox(BOX));
    osg::ComputeBoundsVisitor visitor;
    transform->accept(visitor);
    EXPECT_FLOAT_EQ(visitor.getBoundingBox().xMin(), 99.0f);
    EXPECT_FLOAT_EQ(visitor.getBoundingBox().zMax(), 9.0f);
    EXPECT_FLOAT_EQ(transform->getBound().center().x(), 101.5f);
    // Node masks count.
    transform->getChild(0)->setNodeMask(0);
    visitor.reset();
    transform->accept(visitor);
    EXPECT_FALSE(visitor.getBoundingBox().valid());
}

TEST(VolumeGeometry, IsNeverTakenForAGeometry)
{
    const osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    EXPECT_EQ(geometry->asGeometry(), nullptr);
    EXPECT_NE(geometry->asDrawable(), nullptr);
    struct Functor : osg::Drawable::AttributeFunctor
    {
    } functor;
    EXPECT_FALSE(geometry->supports(functor));
    EXPECT_FALSE(geometry->getUseDisplayList());
    EXPECT_STREQ(geometry->className(), "VolumeGeometry");
    EXPECT_STREQ(geometry->libraryName(), "osgVolumizer");
}

TEST(VolumeGeometry, FlatteningKeepsTheTransformAboveIt)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::translate(100.0, 0.0, 0.0));
    transform->setDataVariance(osg::Object::STATIC);
    root->addChild(transform);
    const osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    transform->addChild(geometry);
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
    ASSERT_EQ(geometry->getNumParents(), 1u);
    const osg::MatrixList matrices = geometry->getWorldMatrices();
    ASSERT_EQ(matrices.size(), 1u);
    EXPECT_EQ(matrices[0].getTrans(), osg::Vec3d(100.0, 0.0, 0.0));
}

TEST(VolumeGeometry, RefusedSetsLeaveTheOldOneInPlace)
{
    osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    geometry->setName("skull");
    const auto old = geometry->getTetraSet();
    const unsigned count = geometry->getModifiedCount();
    core::TetraSet set = *old;
    set.vertices.setPosition(3, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0});
    clearLastError();
    const Status status = geometry->setTetraSet(set);
    EXPECT_EQ(status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(status.index, 3);
    EXPECT_NE(status.text.find("skull"), std::string::npos);
    EXPECT_EQ(getLastError().text, status.text);
    set = *old;
    set.indices.back() = 8;
    EXPECT_EQ(geometry->setTetraSet(set).code, ErrorCode::INDEX_OUT_OF_RANGE);
    set.indices.pop_back();
    EXPECT_EQ(geometry->setTetraSet(set).code, ErrorCode::SIZE_MISMATCH);
    EXPECT_EQ(geometry->getTetraSet(), old);
    EXPECT_EQ(geometry->getModifiedCount(), count);
}

TEST(VolumeGeometry, ReplacingTheSetMovesTheBound)
{
    osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    const auto old = geometry->getTetraSet();
    const unsigned count = geometry->getModifiedCount();
    EXPECT_FLOAT_EQ(geometry->getBoundingBox().xMax(), 4.0f);
    core::TetraSet set = *old;
    for (std::size_t i = 0; i < set.vertices.size(); ++i)
        set.vertices.setPosition(i, 2.0 * set.vertices.position(i));
    ASSERT_TRUE(geometry->setTetraSet(set));
    EXPECT_FLOAT_EQ(geometry->getBoundingBox().xMax(), 8.0f);
    EXPECT_GT(geometry->getModifiedCount(), count);
    EXPECT_EQ(old->bounds().max.x, 4.0); // whoever holds the old set keeps it
}

TEST(VolumeGeometry, CopiesShareTheSetButNotItsChanges)
{
    osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    geometry->setName("jaw");
    const osg::ref_ptr<VolumeGeometry> copy = osg::clone(geometry.get());
    EXPECT_EQ(copy->getName(), "jaw");
    EXPECT_EQ(copy->getTetraSet(), geometry->getTetraSet());
    EXPECT_TRUE(geometry->setTetraSet(core::TetraSet()));
    EXPECT_EQ(copy->getTetraSet()->tetraCount(), 5u);
    EXPECT_FLOAT_EQ(copy->getBoundingBox().xMax(), 4.0f);
}

TEST(VolumeGeometry, SetsMayBeReplacedWhileOthersLook)
{
    osg::ref_ptr<VolumeGeometry> geometry = VolumeGeometry::createBox(BOX);
    const core::TetraSet set = *geometry->getTetraSet();
    std::thread reader([&] {
        for (int i = 0; i < 2000; ++i)
            ASSERT_EQ(geometry->getTetraSet()->tetraCount(), 5u);
    });
    for (int i = 0; i < 2000; ++i)
        ASSERT_TRUE(geometry->setTetraSet(set));
    reader.join();
    EXPECT_EQ(geometry->getModifiedCount(), 2001u);
}

} // namespace

} // namespace VolumeGeometryTest
