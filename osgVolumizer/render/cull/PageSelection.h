#pragma once

#include "../textures/Pages.h"
#include "../volume/VolumeInstance.h"

#include "../../core/voxels/BrickTree.h"
#include "../../core/voxels/VoxelData.h"

#include <osg/Polytope>

#include <array>
#include <optional>
#include <unordered_set>
#include <vector>

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// What pages are chosen for: what the camera sees now, or will see.
struct PageView
{
    glm::dmat4 toEye{1.0};                ///< from the volume's frame
    std::optional<osg::Polytope> frustum; ///< of that frame; none for the visitor's own
};

/// The pages of a volume that a view should be drawn from: from the coarsest level downwards,
/// wherever a page's samples are further apart than pixels, as far as there is room for their
/// textures; none that show nothing, are outside the view or hidden, or would be finer than pixels.
class PageSelection
{
public:
    /// \param steps that are looked at \param view as which the pages are chosen
    PageSelection(VolumeInstance& volume, const Voxels& voxels, const TimeSteps& steps,
                  const PageView& view, bool skipping, const std::shared_ptr<Pages>& pages,
                  osgUtil::CullVisitor& visitor);

    /// Chooses pages, looks what there is of them, and what of it can be uploaded in this frame.
    /// Those that are only read ahead may be let go of for all others.
    enum Purpose
    {
        TO_DRAW,
        INSTEAD, ///< of steps that are not there yet: nothing more is uploaded
        AHEAD
    };
    void choose(Purpose purpose);
    /// Whether the picture is the final one.
    bool isComplete() const { return _missing == 0; }
    bool hasFailed() const { return _failed > 0; }
    std::int64_t missing() const { return _missing; }

    /// Hands what there is to the volume, far to near.
    void draw();
    /// What is to be uploaded in this frame although another selection is drawn.
    std::vector<DrawnBrick> uploads() const;
    /// Appends what is missing of the pages. \param lowered steps by which its priority is below
    /// that of all that is to be drawn; 0 for that
    void appendRequests(int lowered, std::vector<PageRequest>& requests) const;
    /// Of all pages, once they are read.
    std::int64_t memoryBytes() const;
    void report(std::int64_t missing, std::int64_t waiting, std::int64_t ahead) const;

private:
    /// A page that may be drawn. The nodes of a parent's children follow each other.
    struct Node
    {
        std::int64_t index = 0;
        core::TreeBrick brick;
        core::Box3d box; ///< voxel frame; of its clip box, what is in the region
        /// Of each time step, the one value of all that it stands for, where all have one.
        std::array<std::optional<double>, 2> values;
        bool uniform = false;
        core::ValueRange range; ///< of all steps; empty where it is not known
        double error = 0.0;     ///< pixels between its samples, where it is nearest
        float priority() const { return static_cast<float>(std::min(error, 1e30)); }
        std::int64_t parent = -1;
        std::size_t firstChild = 0, childCount = 0;
        bool split = false; ///< its children are to be drawn instead
        VisibilityTest::Answer answer = VisibilityTest::UNKNOWN;
        bool covered = false;  ///< by opaque pages in front
        bool hidden = false;   ///< by those or opaque geometry: neither split nor read
        bool withheld = false; ///< likewise, until it is known whether what it lies in is hidden
        bool isWithinVisible = false; ///< something that it lies in is visible, as far as is known
        std::array<Pages::Page, 2> pages;   ///< of each time step
        Pages::State state = Pages::ABSENT; ///< of what there is least of
        bool available = false;             ///< it can be drawn in this frame
        bool below = false;                 ///< it can, or something below it
        bool missing = false;               ///< it, or something below it, has not been read
        bool shows = false;                 ///< it, or something below it, is to be drawn
    };

    PageKeeper::Key keyOf(const Node& node, int step) const
    {
        return {node.index, _volume.look->features.gradientTexture, _steps.step(step)};
    }
    /// Of a time step.
    std::int64_t textureBytes(const Node& node) const;
    std::int64_t memoryBytes(const Node& node) const;

    std::optional<Node> make(std::int64_t index);
    double roomForTextures() const; ///< bytes, in one frame
    double sampleDistance(const Node& node) const;
    bool canCover() const;
    void findCovered();
    void add(std::int64_t index, std::int64_t parent);
    void refine();
    bool isEmpty(Node& node) const;
    bool isOutside(const core::Box3d& box);
    void look(Node& node, Purpose purpose);
    void chooseUploads();
    void passUp();
    void draw(std::size_t number, const Node* coarser);
    void findHidden(Node& node) const;
    void append(const Node& node, const Node& place);
    DrawnBrick drawnBrick(const Node& node, int step) const;
    static bool isTooCoarse(const Node& node);
    static bool isFinal(const Node& node);
    std::shared_ptr<const BrickCells> cellsOf(const Node& node) const;
    bool isCutAway(const Node& node) const;
    bool cutToOccupied(const Node& node, SelectedBrick& brick);

    VolumeInstance& _volume;
    const Voxels& _voxels;
    const core::BrickTree& _tree;
    const TimeSteps _steps;
    const bool _skipping;
    osgUtil::CullVisitor& _visitor;
    const OccupancyQuery _query;
    const std::shared_ptr<Pages> _pages;
    PageView _view;
    const unsigned _frame, _contextId;
    osg::Matrixd _toClip;                         ///< of slabs in the voxel frame, as what follows
    std::shared_ptr<const VisibilityTest> _known; ///< of an earlier frame; or null
    std::shared_ptr<VisibilityTest> _test;        ///< of this one
    bool _hasOpaque = false;                      ///< as far as earlier frames know
    glm::dvec4 _eye;
    double _voxelsPerPixel = 0.0; ///< where clip w is 1
    std::vector<Node> _nodes;     ///< parents before children
    std::size_t _rootCount = 0;
    std::unordered_set<std::int64_t> _covered; ///< by opaque pages, as far as was looked
    std::int64_t _missing = 0, _failed = 0, _empty = 0;
    bool _limited = false; ///< by the budget
};

} // namespace render
} // namespace osgVolumizer
