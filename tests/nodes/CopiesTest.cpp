// Deep copies share nothing that can be changed; shallow ones share voxels and table.

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <gtest/gtest.h>

#include <map>

namespace CopiesTest {

using namespace osgVolumizer;

namespace {

osg::ref_ptr<Voxels> makeVoxels()
{
    VoxelSource::Description description;
    description.size = glm::ivec3(4);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(description));
    static_cast<unsigned char*>(source->data())[5] = 99;
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    EXPECT_TRUE(voxels->setBrickSize({3, 3, 3}));
    EXPECT_TRUE(voxels->setRange({2.0, 7.0}));
    EXPECT_TRUE(voxels->setSpacing({1.0, 2.0, 3.0}));
    return voxels;
}

unsigned char* samples(VolumeAppearance& appearance)
{
    auto* source = dynamic_cast<MemoryVoxelSource*>(appearance.getVoxels()->getSource());
    return source ? static_cast<unsigned char*>(source->data()) : nullptr;
}

osg::ref_ptr<VolumeAppearance> makeAppearance(Voxels* voxels)
{
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(voxels);
    appearance->getLookupTable()->setName("own");
    appearance->addChild(VolumeGeometry::createBox(*voxels));
    return appearance;
}

osg::CopyOp::CopyFlags without(osg::CopyOp::CopyFlags flag)
{
    return osg::CopyOp::DEEP_COPY_ALL & ~flag;
}

TEST(Copies, DeepOnesOfAnAppearanceShareNothing)
{
    const osg::ref_ptr<VolumeAppearance> original = makeAppearance(makeVoxels());
    const osg::ref_ptr<VolumeAppearance> copy =
        osg::clone(original.get(), osg::CopyOp::DEEP_COPY_ALL);
    ASSERT_NE(copy->getVoxels(), nullptr);
    ASSERT_NE(copy->getVoxels(), original->getVoxels());
    ASSERT_NE(copy->getLookupTable(), original->getLookupTable());
    EXPECT_EQ(copy->getLookupTable()->getName(), "own");
    ASSERT_NE(copy->getVoxels()->getSource(), original->getVoxels()->getSource());

    const auto before = original->getLookupTable()->getFunction();
    ASSERT_TRUE(copy->getLookupTable()->setRamp(0.2, 0.1));
    EXPECT_EQ(original->getLookupTable()->getFunction(), before);

    ASSERT_NE(samples(*copy), nullptr);
    EXPECT_EQ(samples(*copy)[5], 99);
    samples(*copy)[5] = 1;
    EXPECT_EQ(samples(*original)[5], 99);

    EXPECT_EQ(copy->getVoxels()->getRange(), osg::Vec2d(2.0, 7.0));
    EXPECT_EQ(copy->getVoxels()->getLayout().brickCount(), 8);
    ASSERT_TRUE(copy->getVoxels()->setSpacing({9.0, 9.0, 9.0}));
    ASSERT_TRUE(copy->getVoxels()->setRange({0.0, 1.0}));
    ASSERT_TRUE(copy->getVoxels()->setBrickSize({64, 64, 64}));
    EXPECT_EQ(original->getVoxels()->getSpacing(), osg::Vec3d(1.0, 2.0, 3.0));
    EXPECT_EQ(original->getVoxels()->getRange(), osg::Vec2d(2.0, 7.0));
    EXPECT_EQ(original->getVoxels()->getBrickSize(), osg::Vec3i(3, 3, 3));
}

TEST(Copies, DeepOnesOfAGeometryAreChangedAlone)
{
    const osg::ref_ptr<VolumeAppearance> original = makeAppearance(makeVoxels());
    const osg::ref_ptr<VolumeAppearance> copy =
        osg::clone(original.get(), osg::CopyOp::DEEP_COPY_ALL);
    auto* from = dynamic_cast<VolumeGeometry*>(original->getChild(0));
    auto* to = dynamic_cast<VolumeGeometry*>(copy->getChild(0));
    ASSERT_NE(to, nullptr);
    ASSERT_NE(from, to);
    EXPECT_EQ(from->getTetraSet()->tetraCount(), to->getTetraSet()->tetraCount());
    ASSERT_TRUE(to->setTetraSet(core::TetraSet()));
    EXPECT_EQ(from->getTetraSet()->tetraCount(), 5u);
}

// What the Optimizer and others copy with: nodes and drawables, and not what they refer to.
TEST(Copies, WithoutObjectsShareVoxelsAndTable)
{
    const osg::ref_ptr<VolumeAppearance> original = makeAppearance(makeVoxels());
    for (const osg::CopyOp::CopyFlags flags :
         {without(osg::CopyOp::DEEP_COPY_OBJECTS),
          osg::CopyOp::CopyFlags(osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES),
          osg::CopyOp::CopyFlags(osg::CopyOp::SHALLOW_COPY)}) {
        const osg::ref_ptr<VolumeAppearance> copy = osg::clone(original.get(), osg::CopyOp(flags));
        EXPECT_EQ(copy->getVoxels(), original->getVoxels());
        EXPECT_EQ(copy->getLookupTable(), original->getLookupTable());
    }
}

TEST(Copies, OfIncompleteOnes)
{
    const osg::ref_ptr<VolumeAppearance> empty = new VolumeAppearance;
    const osg::ref_ptr<VolumeAppearance> copy = osg::clone(empty.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(copy->getVoxels(), nullptr);
    EXPECT_NE(copy->getLookupTable(), nullptr);
    const osg::ref_ptr<Voxels> voxels = new Voxels;
    const osg::ref_ptr<Voxels> voxelsCopy = osg::clone(voxels.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_FALSE(voxelsCopy->valid());
}

// Voxels that two appearances share become two, each right by itself; an operator that remembers
// what it has copied keeps them shared.
TEST(Copies, SharedVoxels)
{
    struct Remembering : osg::CopyOp
    {
        Remembering() : osg::CopyOp(DEEP_COPY_ALL) {}
        osg::Object* operator()(const osg::Object* object) const override
        {
            osg::ref_ptr<osg::Object>& copy = copies[object];
            if (!copy) copy = osg::CopyOp::operator()(object);
            return copy;
        }
        osg::Node* operator()(const osg::Node* node) const override
        {
            return osg::CopyOp::operator()(node);
        }
        mutable std::map<const osg::Object*, osg::ref_ptr<osg::Object>> copies;
    };
    const osg::ref_ptr<Voxels> voxels = makeVoxels();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(makeAppearance(voxels));
    scene->addChild(makeAppearance(voxels));
    const auto voxelsOf = [](osg::Group& group, unsigned i) {
        return dynamic_cast<VolumeAppearance&>(*group.getChild(i)).getVoxels();
    };
    const osg::ref_ptr<osg::Group> plain = osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_NE(voxelsOf(*plain, 0), voxelsOf(*plain, 1));
    for (unsigned i : {0u, 1u}) {
        EXPECT_NE(voxelsOf(*plain, i), voxels);
        EXPECT_EQ(voxelsOf(*plain, i)->getBrick(0).data[4], 99);
    }
    const Remembering remember;
    const osg::ref_ptr<osg::Group> shared = static_cast<osg::Group*>(scene->clone(remember));
    EXPECT_EQ(voxelsOf(*shared, 0), voxelsOf(*shared, 1));
    EXPECT_NE(voxelsOf(*shared, 0), voxels);
}

// Memory of the application is copied, and released when the original is gone.
TEST(Copies, OfExternalSamples)
{
    std::vector<unsigned char> bytes(8, 7);
    bool released = false;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    VoxelSource::Description description;
    description.size = glm::ivec3(2);
    ASSERT_TRUE(source->setExternal(description, bytes.data(), [&] { released = true; }));
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    source = nullptr;
    const osg::ref_ptr<Voxels> copy = osg::clone(voxels.get(), osg::CopyOp::DEEP_COPY_ALL);
    voxels = nullptr;
    EXPECT_TRUE(released);
    bytes.assign(8, 0);
    EXPECT_EQ(copy->getBrick(0).data[3], 7);
}

} // namespace

} // namespace CopiesTest
