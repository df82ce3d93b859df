// What picks read and skip, and several of them at once.
#include "PickOracle.h"

#include <osgVolumizer/interact/private/FirstHit.h>
#include <osgVolumizer/interact/private/VolumeView.h>

#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <atomic>
#include <thread>

namespace PickWorkTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

// Counts what is read; shares no memory.
class CountingSource : public MemoryVoxelSource
{
public:
    Status read(const core::Box3i& region, void* destination) const override
    {
        ++reads;
        return MemoryVoxelSource::read(region, destination);
    }
    VoxelBlock share(const core::Box3i&) const override { return {}; }
    mutable std::atomic<int> reads{0};
};

TEST(PickWork, ReadsABrickOnce)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(96);
    osg::ref_ptr<CountingSource> source = new CountingSource;
    ASSERT_TRUE(source->allocate(description).ok());
    auto* bytes = static_cast<unsigned char*>(source->data());
    for (int i = 0; i < 96 * 96 * 96; ++i)
        bytes[i] = static_cast<unsigned char>(i % 96);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    ASSERT_TRUE(voxels->setBrickSize({33, 33, 33}).ok());
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    RandomLines lines(glm::dvec3(0.0), glm::dvec3(95.0));
    for (int i = 0; i < 300; ++i)
        pickLine(*appearance, lines.next());
    EXPECT_LE(source->reads, voxels->getLayout().brickCount());
    const auto cache = picking::pickData<picking::SampleCache>(*voxels);
    const auto before = cache->readCount();
    EXPECT_LE(before, std::uint64_t(voxels->getLayout().brickCount()));
    for (int i = 0; i < 300; ++i)
        pickLine(*appearance, lines.next());
    voxels->dirty(0);
    for (int i = 0; i < 300; ++i)
        pickLine(*appearance, lines.next());
    EXPECT_LE(cache->readCount(), before + 1);
}

// A ray that grazes a small ball in a large empty volume looks into few cells.
TEST(PickWork, SkipsWhatIsEmpty)
{
    const auto voxels = makeBlob(glm::ivec3(128), 5.0);
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable({{0.2, {1, 1, 1, 0.0}}, {1.0, {1, 1, 1, 0.5}}}));
    const picking::VolumeView view(geometryBelow(*appearance), *appearance, 0.0);
    const picking::Segment segment{{60, 62, -10}, {64, 63, 150}};
    const auto spans = view.region->spans(segment, {});
    ASSERT_EQ(spans.size(), 1u);
    const auto field = view.fieldOf(0);
    int cells = 0;
    picking::walkCells(
        *field, spans[0], [&](const core::ValueRange& range) { return view.shows(range); },
        [&](const picking::CellPart&) {
            ++cells;
            return true;
        });
    EXPECT_GT(cells, 10);
    EXPECT_LT(cells, 50); // of 140
}

TEST(PickWork, FourThreadsPickWhileTheTableChanges)
{
    const auto voxels = makeBlob(glm::ivec3(48), 8.0);
    ASSERT_TRUE(voxels->setBrickSize({17, 17, 17}).ok());
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    const Points thin = smoothPoints(0.3), thick = smoothPoints(0.9);
    const Line line{{23, 24, -40}, {24, 23, 90}};
    appearance->setLookupTable(makeTable(thin));
    const double thinRatio = pickLine(*appearance, line)->ratio;
    appearance->setLookupTable(makeTable(thick));
    const double thickRatio = pickLine(*appearance, line)->ratio;
    ASSERT_GT(thinRatio - thickRatio, 1e-3);
    std::atomic<bool> done{false};
    std::atomic<int> picks{0}, wrong{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            while (!done) {
                osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
                    new osgUtil::LineSegmentIntersector(toVec3d(line.start), toVec3d(line.end));
                osgUtil::IntersectionVisitor visitor(segment);
                appearance->accept(visitor);
                const double ratio = segment->getFirstIntersection().ratio;
                const double off =
                    std::min(std::fabs(ratio - thinRatio), std::fabs(ratio - thickRatio));
                if (!(off < 1e-9)) ++wrong;
                ++picks;
            }
        });
    for (int i = 0; i < 200 || picks < 400; ++i) {
        appearance->getLookupTable()->setPoints(i % 2 ? thin : thick, LookupTable::RANGE_FRACTION);
        std::this_thread::yield();
    }
    done = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(picks, 400);
}

} // namespace

} // namespace PickWorkTest
