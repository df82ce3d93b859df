#pragma once

#include "BrickTexture.h"
#include "PageCells.h"
#include "PageQueue.h"
#include "VisibilityTest.h"

#include "../../Voxels.h"
#include "TimeSteps.h"

#include <osg/Image>
#include <osg/View>
#include <osg/observer_ptr>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The pages of one Voxels on their way from the source into contexts: read by the threads of
/// PageQueue, kept in main memory until each context that wants them has them and as long as there
/// is room, and in contexts as long as there is room there. Pages of neighbouring time steps that
/// turn out to be the same are kept, and uploaded, once. Thread safe; nothing here waits for a
/// source.
class Pages : public PageKeeper, public std::enable_shared_from_this<Pages>
{
public:
    /// What a view can do with a page.
    enum State
    {
        ABSENT,
        READ,     ///< it can be uploaded
        RESIDENT, ///< the context has it
        FAILED    ///< the source did not give it; it is tried again later
    };
    /// A page that a view looks at, and for how long it is to stay.
    struct Look
    {
        Key key;
        unsigned contextId = 0, frame = 0;
        float priority = 0.0f; ///< below 0: may be let go of for any other
    };
    struct Page
    {
        State state = ABSENT;
        osg::ref_ptr<BrickTexture> texture;    ///< where read or resident
        osg::ref_ptr<const osg::Image> texels; ///< where read
        int offers = 0;                        ///< how often offer() was called for it
        std::shared_ptr<PageCells> cells; ///< where read or resident; null where it has one value
    };

    ~Pages() override;

    /// Forgets pages of another state of the data, where only samples have changed those that
    /// stand for any. Call before the others, in each frame.
    void begin(const Voxels& voxels);
    /// Marks a page as used.
    Page look(const Look& look);
    /// Tells that a page may be uploaded in this frame. It still is not where nothing of it is
    /// drawn.
    void offer(const Key& key);
    /// Puts a page of one value there without reading it.
    void provide(const Key& key, const Voxels& voxels, double value);
    /// Asks for pages in place of those that the view asked for before. Those that are there, or
    /// failed a short while ago, are left out. Returns how many are waited for.
    std::int64_t ask(std::uint64_t viewId, std::vector<PageRequest> requests);

    /// What is known of a view from its frame before.
    struct ViewState
    {
        std::optional<TimeSteps> shown;      ///< the last that were there with all that was needed
        std::optional<TimeSteps> pending;    ///< those that are waited for
        int ahead = 1;                       ///< how far ahead is being read
        std::int64_t missing = -1;           ///< pages, as it was last told; -1: never
        osg::observer_ptr<osg::View> goesOn; ///< that was told to draw again and again; or null
        std::optional<osg::Matrixd> toEye;   ///< from the volume's frame
    };
    ViewState stateOf(std::uint64_t viewId) const;
    void setState(std::uint64_t viewId, unsigned frame, const ViewState& state);

    /// What is found out in a frame of a view, of which the last few are kept.
    void addTest(std::uint64_t viewId, const std::shared_ptr<VisibilityTest>& test);
    /// The newest of the last few frames with all its answers; null where there is none, or nothing
    /// opaque in it.
    std::shared_ptr<const VisibilityTest> lastTest(std::uint64_t viewId, unsigned frame) const;
    /// Whether there was anything opaque in the view lately.
    bool hadOpaque(std::uint64_t viewId) const;

    /// Tells a viewer that draws on demand to go on, as long as any voxels want that.
    static void setContinuous(osg::View& view);

    /// How many views look at any paged voxels, this one of `pages` included: those of this frame
    /// and the one before.
    static std::size_t viewCount(unsigned frame, Pages& pages, std::uint64_t viewId);
    /// Releases textures of paged voxels in the context of a state where the budget has no room for
    /// one more: those used longest ago, of any voxels. Call in the draw thread before it is
    /// uploaded.
    static void makeRoom(osg::State& state, const BrickTexture& texture);
    /// Of the textures of all paged voxels in a context.
    static std::int64_t textureBytes(unsigned contextId);

    std::int64_t read(const Key& key) override;
    std::int64_t release(std::int64_t bytes) override;

    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state);

    /// One of a Voxels; registered for makeRoom().
    static std::shared_ptr<Pages> create();

private:
    /// What was read, of one page or of several time steps of it.
    struct Content
    {
        osg::ref_ptr<BrickTexture> texture;
        osg::ref_ptr<const osg::Image> texels; ///< null once let go of
        std::shared_ptr<PageCells> cells;
        std::int64_t bytes = 0; ///< of the texels in memory
        unsigned lastFrame = 0;
        float priority = 0.0f;
        int offers = 0; ///< since it was read

        bool isGone() const { return !texels && !texture->isAnywhere(); }
    };
    using ContentPtr = std::shared_ptr<Content>;
    struct Entry
    {
        ContentPtr content; ///< null until it was read
        bool reading = false;
        int failures = 0;
        double retryTime = 0.0; ///< seconds, by osg::Timer
    };
    struct View
    {
        unsigned frame = 0; ///< the last one
        ViewState state;
        std::deque<std::shared_ptr<VisibilityTest>> tests; ///< newest first
    };

    Pages() = default;
    static std::int64_t bytesOf(const std::map<Key, Entry>& entries);
    void forgetChanged(const Voxels& voxels, std::map<Key, Entry>& forgotten);
    void fail(const Key& key, const Status& status);
    ContentPtr findTwin(const Key& key, const osg::Image& texels) const;
    std::int64_t keep(const Key& key, const ContentPtr& twin, const ContentPtr& content);
    std::vector<ContentPtr> contents() const;
    std::int64_t textureBudget() const;
    void eraseGone(const BrickTexture* kept);

    mutable std::mutex _mutex; ///< of what follows
    osg::observer_ptr<const Voxels> _voxels;
    unsigned _modified = 0, _layout = 0, _changes = 0, _generation = 0;
    unsigned _frame = 0;             ///< the last one that looked at anything
    std::int64_t _textureBudget = 0; ///< of these; 0: none
    std::map<Key, Entry> _entries;
    std::map<std::uint64_t, View> _views; ///< of this frame and the one before
    bool _reported = false;               ///< that the source fails
};

/// How much a context may be handed in a frame: the bytes that take the budget's milliseconds, as
/// measured; where frames are slow, a tenth of what they take. Thread safe.
class UploadAllowance
{
public:
    static UploadAllowance& of(unsigned contextId);

    /// Whether so many bytes more may be uploaded in a frame; they then count. The first of a frame
    /// always may.
    bool take(unsigned frame, std::int64_t bytes);
    void measured(std::int64_t bytes, double milliseconds);

private:
    std::mutex _mutex;
    unsigned _frame = 0;
    double _begin = 0.0;   ///< of this frame, seconds
    double _allowed = 0.0; ///< milliseconds of this frame
    double _taken = 0.0;
    double _millisecondsPerByte = 1e-6;
};

} // namespace render
} // namespace osgVolumizer
