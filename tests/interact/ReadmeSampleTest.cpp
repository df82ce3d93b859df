// The README's sample of picking: as it stands there, and that it does what it says.
#include "PickOracle.h"

#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/VolumeSlice.h>
#include <osgVolumizer/interact/Probe.h>

#include <osg/ShapeDrawable>
#include <osgViewer/Viewer>

#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

namespace ReadmeSampleTest {

using namespace osgVolumizer::test;

namespace {

// clang-format off
void pickAndProbe(osgViewer::Viewer& viewer, double x, double y, const osg::Vec3d& eye)
{
const auto seen = osgVolumizer::zpick(*viewer.getCamera(), x, y); // pixels from the lower left corner
if (!seen.ok() || !seen->has_value()) return;                     // nothing there
const osg::Vec3d point = (*seen)->point;                          // world frame
if (!(*seen)->isVolume) return;                                   // a surface in front of all volumes
const auto line = osgVolumizer::probe((*seen)->nodePath, eye, eye + (point - eye) * 2.0);
for (const osgVolumizer::ProbedVoxel& voxel : line.value.voxels)
    std::cout << voxel.distance << ": " << voxel.raw << ", " << voxel.transmittance << std::endl;
} // end

void addSlice(osgVolumizer::VolumeAppearance* appearance, const osg::Vec3d& point, const osg::Vec3d& normal)
{
osg::ref_ptr<osgVolumizer::VolumeSlice> slice = new osgVolumizer::VolumeSlice;
slice->setPlane(point, normal); // object frame, as all of these
slice->setWindow(80.0, 160.0);  // centre and width, data values
slice->setThickness(5.0);       // the largest value within 2.5 units on each side
slice->setReduction(osgVolumizer::VolumeSlice::MAXIMUM);
appearance->addChild(slice);
} // end of slices

void cutAway(osgVolumizer::VolumeAppearance* volume, osg::Drawable* mesh, osgVolumizer::Voxels* labels)
{
osg::ref_ptr<osgVolumizer::VolumeCut> cut = new osgVolumizer::VolumeCut;
cut->addRegion(osgVolumizer::CutRegion::sphere({64, 64, 40}, 50.0));                    // within
cut->addRegion(osgVolumizer::CutRegion::box({64, 0, 0, 128, 64, 128}).complement());    // but for a corner
cut->addRegion(osgVolumizer::CutRegion::surface(*mesh).complement());                   // and an implant
cut->addRegion(osgVolumizer::CutRegion::mask(labels, 3, 5));                            // of these labels
cut->setSoftness(2.0);                                                                  // fading over 2 units
volume->setCut(cut);
} // end of cutting
// clang-format on

std::string textOf(const std::string& file)
{
    std::ifstream stream(OSGVOLUMIZER_SOURCE_DIR "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ReadmeSample, IsThisOne)
{
    const std::string own = textOf("tests/interact/ReadmeSampleTest.cpp");
    const std::size_t begin = own.find("const auto seen"), end = own.find("} // end");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
}

TEST(ReadmeSample, OfSlicesIsThisOne)
{
    const std::string own = textOf("tests/interact/ReadmeSampleTest.cpp");
    const std::size_t begin = own.find("osg::ref_ptr<osgVolumizer::VolumeSlice> slice"),
                      end = own.find("} // end of slices");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
    const osg::ref_ptr<osgVolumizer::VolumeAppearance> appearance =
        makeVolume(makeBlob(glm::ivec3(8), 2.0));
    addSlice(appearance, osg::Vec3d(3, 3, 3), osg::Vec3d(0, 0, 1));
    ASSERT_EQ(appearance->getNumChildren(), 2u);
    const auto* slice = dynamic_cast<const osgVolumizer::VolumeSlice*>(appearance->getChild(1));
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->getPlane(), osg::Vec4d(0, 0, 1, -3));
    EXPECT_NEAR(slice->getBoundingBox().xMax(), 7.0, 1e-5);
}

TEST(ReadmeSample, Cuts)
{
    const std::string own = textOf("tests/interact/ReadmeSampleTest.cpp");
    const std::size_t begin = own.find("osg::ref_ptr<osgVolumizer::VolumeCut> cut"),
                      end = own.find("} // end of cutting");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
    const osg::ref_ptr<osgVolumizer::VolumeAppearance> volume =
        makeVolume(makeBlob(glm::ivec3(8), 2.0));
    const osg::ref_ptr<osg::Drawable> mesh =
        new osg::ShapeDrawable(new osg::Sphere({64, 64, 64}, 5.0f));
    cutAway(volume, mesh, volume->getVoxels());
    EXPECT_EQ(volume->getCut()->getNumRegions(), 4u);
}

TEST(ReadmeSample, ListsVoxels)
{
    osgViewer::Viewer viewer;
    viewer.setSceneData(makeVolume(makeBlob(glm::ivec3(32), 6.0)));
    const osg::Vec3d eye(15.5, -100, 15.5);
    viewer.getCamera()->setViewport(0, 0, 200, 100);
    viewer.getCamera()->setProjectionMatrixAsPerspective(30.0, 2.0, 10.0, 500.0);
    viewer.getCamera()->setViewMatrixAsLookAt(eye, {15.5, 15.5, 15.5}, {0, 0, 1});
    std::ostringstream text;
    std::streambuf* const before = std::cout.rdbuf(text.rdbuf());
    pickAndProbe(viewer, 100, 50, eye);
    std::cout.rdbuf(before);
    EXPECT_NE(text.str().find("100.25: "), std::string::npos) << text.str();
}

} // namespace

} // namespace ReadmeSampleTest
