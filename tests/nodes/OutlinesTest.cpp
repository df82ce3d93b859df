#include <osgVolumizer/Outlines.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/sampling/Polygonize.h>

#include <gtest/gtest.h>

#include <cmath>

namespace OutlinesTest {

using namespace osgVolumizer;

TEST(Outlines, OfFacesAreTheirEdges)
{
    // Across the middle of a box of five tetrahedra, along z: its four sides, and what the four
    // corners cut off from the tetrahedron in the middle.
    const auto box = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 4, 6, 2));
    core::Polygonizer polygonizer;
    ASSERT_TRUE(polygonizer.setTetraSet(box->getTetraSet()).ok());
    core::PolygonizedFaces cut;
    ASSERT_TRUE(polygonizer.polygonizeMPR({{0, 0, 1}, -1.0}, {0, 0, 0}, cut).ok());
    ASSERT_EQ(cut.faces.faceCount(), 5u);
    const osg::ref_ptr<osg::Geometry> lines = createFaceOutlines(cut.faces);
    const auto* points = dynamic_cast<const osg::Vec3Array*>(lines->getVertexArray());
    ASSERT_NE(points, nullptr);
    const osg::PrimitiveSet& edges = *lines->getPrimitiveSet(0);
    EXPECT_EQ(edges.getMode(), GLenum(GL_LINES));
    EXPECT_EQ(edges.getNumPrimitives(), 12u); // the sides in halves
    double length = 0.0;
    for (unsigned i = 0; i < edges.getNumIndices(); i += 2)
        length += ((*points)[edges.index(i)] - (*points)[edges.index(i + 1)]).length();
    EXPECT_NEAR(length, 2.0 * (4.0 + 6.0) + 4.0 * std::hypot(2.0, 3.0), 1e-5);
    EXPECT_EQ(lines->getBoundingBox()._min, osg::Vec3(0, 0, 1));
    EXPECT_EQ(lines->getBoundingBox()._max, osg::Vec3(4, 6, 1));
}

} // namespace OutlinesTest
