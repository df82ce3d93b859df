// Plain, AVX2 and AVX-512 loops make the same faces of the same points, to the bit. Where the
// processor lacks one of them, the next best stands in.

#include "TestGeometry.h"
#include "osgVolumizer/core/sampling/private/SliceScan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace InstructionsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;
using namespace osgVolumizer::testing;

namespace {

/// The faces of a range as lists of the bits of their corners, in an order of their own.
std::vector<std::vector<std::uint32_t>> facesOf(const PolygonizedFaces& out, const FaceRange& range)
{
    const auto stride = static_cast<std::size_t>(out.faces.format.stride());
    std::vector<std::vector<std::uint32_t>> faces;
    for (std::uint32_t f = range.firstFace; f < range.firstFace + range.faceCount; ++f) {
        std::vector<std::uint32_t> bits;
        for (const std::uint32_t corner : out.faces.face(f)) {
            const std::size_t at = bits.size();
            bits.resize(at + stride);
            std::memcpy(bits.data() + at, out.faces.record(corner), stride * sizeof(float));
        }
        faces.push_back(std::move(bits));
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

class InstructionSets : public ::testing::TestWithParam<VertexLayout>
{
protected:
    ~InstructionSets() override { limitInstructions(Instructions::AVX512); }

    static PolygonizedFaces polygonized(Instructions most, const TetraSet& set,
                                        const std::vector<Box3d>& boxes, double period)
    {
        limitInstructions(most);
        SamplingParameters p;
        p.periodVoxel = glm::dvec3(period);
        PolygonizedFaces out;
        EXPECT_TRUE(polygonize(set, boxes, viewAlong({1, 2, 3}), p, out).ok());
        return out;
    }
};

} // namespace

TEST_P(InstructionSets, MakeTheSameFaces)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<double> u(-0.2, 0.2);
    TetraSet set = makeGrid(9, 9.0, VertexFormat(GetParam()));
    for (double& v : set.vertices.values())
        v += u(random);
    const std::vector<Box3d> halves{{glm::dvec3(-1.0), {10.0, 10.0, 4.3}},
                                    {{-1.0, -1.0, 4.3}, glm::dvec3(10.0)}};
    // From several surfaces in a tetrahedron to several tetrahedra between surfaces; more than 256
    // in a block.
    for (const double period : {0.005, 0.07, 0.3, 0.9, 3.0})
        for (const bool bricks : {false, true}) {
            const std::vector<Box3d> boxes = bricks ? halves : std::vector<Box3d>();
            const PolygonizedFaces plain = polygonized(Instructions::PLAIN, set, boxes, period);
            EXPECT_FALSE(plain.faces.empty());
            for (const auto most : {Instructions::AVX2, Instructions::AVX512}) {
                const PolygonizedFaces out = polygonized(most, set, boxes, period);
                ASSERT_EQ(out.ranges.size(), plain.ranges.size());
                ASSERT_EQ(out.faces.vertices.size(), plain.faces.vertices.size());
                EXPECT_EQ(std::memcmp(out.faces.vertices.data(), plain.faces.vertices.data(),
                                      plain.faces.vertices.size() * sizeof(float)),
                          0);
                for (std::size_t r = 0; r < out.ranges.size(); ++r)
                    ASSERT_EQ(facesOf(out, out.ranges[r]), facesOf(plain, plain.ranges[r]));
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Layouts, InstructionSets,
                         ::testing::Values(VertexLayout::V3F, VertexLayout::T3F_V3F,
                                           VertexLayout::C4F_V3F, VertexLayout::T3F_C3F_V3F,
                                           VertexLayout::T3F_C4F_V3F));

} // namespace InstructionsTest
