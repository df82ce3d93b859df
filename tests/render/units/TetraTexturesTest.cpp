// What tetrahedra take on the card, and what of it is made anew.
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/render/textures/TetraTextures.h>
#include <osgVolumizer/render/volume/GeometryCache.h>

#include <oracles/TestMeshes.h>

#include <gtest/gtest.h>

#include <cmath>

namespace TetraTexturesTest {

using namespace osgVolumizer;

namespace {

osg::ref_ptr<VolumeGeometry> meshOf(int n)
{
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    EXPECT_TRUE(geometry->setTetraSet(oracle::tetraSet(oracle::latticeMesh(glm::ivec3(n)))).ok());
    return geometry;
}

std::shared_ptr<const render::TetraTextures> texturesOf(const VolumeGeometry& geometry)
{
    const auto cache = render::renderData<render::GeometryCache>(geometry);
    return cache->tetrahedra(geometry, cache->get(geometry, nullptr));
}

const float* valuesOf(const osg::TextureBuffer& texture)
{
    return reinterpret_cast<const float*>(texture.getImage()->data());
}

} // namespace

TEST(TetraTextures, ATetrahedronTakesLessThanHundredBytes)
{
    for (const int n : {10, 40}) {
        const auto geometry = meshOf(n);
        const std::size_t vertices = geometry->getTetraSet()->vertices.size();
        ASSERT_TRUE(geometry->setScalars(std::vector<float>(vertices, 0.5f)).ok());
        const auto textures = texturesOf(*geometry);
        const double bytes = double(textures->bytes()) / double(textures->cellCount);
        std::printf("  %zu tetrahedra: %.1f bytes each\n", textures->cellCount, bytes);
        EXPECT_LT(bytes, 60.0); // 28 where there are many
    }
}

TEST(TetraTextures, OfScalarsThatChangeOnlyTheseAreMadeAnew)
{
    const auto geometry = meshOf(3);
    const std::size_t vertices = geometry->getTetraSet()->vertices.size();
    ASSERT_TRUE(geometry->setScalars(std::vector<float>(vertices, 1.0f)).ok());
    const auto first = texturesOf(*geometry);
    EXPECT_EQ(texturesOf(*geometry), first);
    std::vector<float> next(vertices, 2.0f);
    next[0] = 4.0f;
    next[1] = NAN;
    ASSERT_TRUE(geometry->setScalars(next).ok());
    const auto second = texturesOf(*geometry);
    EXPECT_EQ(second->graph, first->graph);
    EXPECT_EQ(second->positions, first->positions);
    EXPECT_NE(second->scalars, first->scalars);
    EXPECT_EQ(second->scalars->getImage()->getTotalSizeInBytes(), 4 * vertices);
    EXPECT_FLOAT_EQ(valuesOf(*second->scalars)[0], 1.0f);
    EXPECT_GT(valuesOf(*second->scalars)[1], 1e38f);
    EXPECT_FLOAT_EQ(valuesOf(*second->scalars)[2], 0.0f);
    // Another range counts as a change; other tetrahedra are another mesh.
    ASSERT_TRUE(geometry->setScalarRange(osg::Vec2d(0.0, 8.0)).ok());
    const auto third = texturesOf(*geometry);
    EXPECT_FLOAT_EQ(valuesOf(*third->scalars)[0], 0.5f);
    EXPECT_EQ(third->graph, first->graph);
    ASSERT_TRUE(geometry->setTetraSet(oracle::tetraSet(oracle::latticeMesh(glm::ivec3(2)))).ok());
    EXPECT_EQ(geometry->getScalars(), nullptr);
}

} // namespace TetraTexturesTest
