// The README's sample of draggers: as it stands there, and that it does what it says.
#include "Drags.h"
#include "PickOracle.h"

#include <osgVolumizer/interact/CutDragger.h>
#include <osgVolumizer/interact/LatticeDragger.h>

#include <fstream>
#include <iterator>

namespace ReadmeDraggersTest {

using namespace osgVolumizer::test;

namespace {

// clang-format off
osg::ref_ptr<osgVolumizer::DragHistory> addHandles(osgVolumizer::VolumeAppearance* head, osgVolumizer::VolumeGeometry* region)
{
const osg::BoundingBoxd box = region->getBoundingBox();
head->setCut(new osgVolumizer::VolumeCut);
head->getCut()->addRegion(osgVolumizer::CutRegion::halfSpace({0.0, 1.0, 0.0, -box.center().y()}));
const auto knife = osgVolumizer::CutDragger::create(head->getCut(), 0, box); // handles of region 0
const auto lattice = osgVolumizer::LatticeDeformer::create(region, *head->getVoxels(), box, {3, 3, 3}, {8, 8, 8});
osg::ref_ptr<osgVolumizer::LatticeDragger> bend = new osgVolumizer::LatticeDragger(lattice->get());
osg::ref_ptr<osgVolumizer::DragHistory> history = new osgVolumizer::DragHistory; // history->undo()
(*knife)->setHistory(history);
bend->setHistory(history);
region->getParent(0)->addChild(*knife); // beside the geometry: in its frame
region->getParent(0)->addChild(bend);
return history;
} // end
// clang-format on

std::string textOf(const std::string& file)
{
    std::ifstream stream(OSGVOLUMIZER_SOURCE_DIR "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ReadmeDraggers, AreThese)
{
    const std::string own = textOf("tests/interact/ReadmeDraggersTest.cpp");
    const std::size_t begin = own.find("const osg::BoundingBoxd box"),
                      end = own.find("return history");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
}

TEST(ReadmeDraggers, CutAndBend)
{
    const auto head = makeVolume(makeVoxels(glm::ivec3(16), bumps));
    osgVolumizer::VolumeGeometry& region = geometryBelow(*head);
    const auto history = addHandles(head, &region);
    ASSERT_EQ(head->getNumChildren(), 3u);
    for (unsigned i : {1u, 2u})
        translate(*dynamic_cast<osgVolumizer::VolumeHandles&>(*head->getChild(i)).getDragger(0),
                  osg::Vec3d(0.0, 0.1, 0.0));
    EXPECT_LT(head->getCut()->getRegion(0).getPlane().w(), -8.0);
    EXPECT_GT(region.getTetraSet()->vertices.position(0).y, 0.01);
    EXPECT_TRUE(history->undo() && history->undo());
    EXPECT_EQ(head->getCut()->getRegion(0).getPlane().w(), -7.5);
    EXPECT_EQ(region.getTetraSet()->vertices.position(0).y, 0.0);
}

} // namespace

} // namespace ReadmeDraggersTest
