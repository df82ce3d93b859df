#include "SelectPages.h"

#include "../context/Matrices.h"
#include "BrickSelection.h"
#include "PageSelection.h"

#include "../../Paging.h"
#include "../textures/BrickResidency.h"

#include <osgUtil/CullVisitor>

#include <glm/matrix.hpp>

#include <algorithm>
#include <functional>

namespace osgVolumizer {
namespace render {

namespace {

// What follows where time goes on, as far ahead as there is room for in half of the budget: one
// step a frame, the next one once all of that has been read.
void appendStepsAhead(const VolumeInstance& volume, const TimeSteps& steps,
                      std::int64_t bytesOfStep,
                      const std::function<PageSelection(const TimeSteps&)>& selection, int& ahead,
                      std::vector<PageRequest>& requests)
{
    constexpr int MOST = 3;
    const std::int64_t room = getPagingBudget().memoryBytes / 2;
    if (ahead > MOST || (ahead + 1) * bytesOfStep > room) ahead = 1;
    if ((ahead + 1) * bytesOfStep > room) return;
    const TimeSteps next = stepsAhead(*volume.appearance, steps, ahead);
    const std::size_t before = requests.size();
    if (!next.sameSteps(steps)) {
        PageSelection pages = selection(next);
        pages.choose(PageSelection::AHEAD);
        pages.appendRequests(ahead, requests);
    }
    if (requests.size() == before) ++ahead;
}

// What the camera will see some frames from now if it goes on as from the frame before to this one;
// none where it rests.
std::optional<PageView> viewAhead(const VolumeInstance& volume,
                                  const std::optional<osg::Matrixd>& before,
                                  const osg::Matrixd& projection)
{
    constexpr int DOUBLINGS = 3; // of one frame
    if (!before || !volume.prepared->voxelFrame || !differs(*before, *volume.frameToEye))
        return std::nullopt;
    const glm::dmat4 now = toGlm(*volume.frameToEye);
    glm::dmat4 motion = now * glm::inverse(toGlm(*before));
    for (int i = 0; i < DOUBLINGS; ++i)
        motion = motion * motion;
    PageView view;
    view.toEye = motion * now;
    const osg::Matrixd toClip = toOsg(view.toEye) * projection;
    if (toClip.isNaN()) return std::nullopt;
    view.frustum.emplace();
    view.frustum->setToUnitFrustum(false, false);
    view.frustum->transformProvidingInverse(toClip);
    return view;
}

// As much of it as a quarter of the budget holds, the coarsest first.
void appendViewAhead(PageSelection pages, std::vector<PageRequest>& requests)
{
    std::vector<PageRequest> ahead;
    pages.choose(PageSelection::AHEAD);
    pages.appendRequests(1, ahead);
    std::stable_sort(ahead.begin(), ahead.end(), [](const PageRequest& a, const PageRequest& b) {
        return a.priority > b.priority;
    });
    std::int64_t room = getPagingBudget().memoryBytes / 4;
    for (const PageRequest& request : ahead)
        if ((room -= request.bytes) >= 0) requests.push_back(request);
}

// Tells a view how far its picture is, and a viewer that draws on demand to go on until it is
// final. A request to draw once would be forgotten: it comes while a frame is drawn.
void tell(const Voxels& voxels, std::int64_t missing, bool plays, std::uint64_t viewId,
          Pages::ViewState& known, Pages& pages, osgUtil::CullVisitor& visitor)
{
    const osg::Camera* camera = visitor.getCurrentCamera();
    const bool changed = known.missing < 0 || (known.missing == 0) != (missing == 0);
    osg::View* view = camera ? const_cast<osg::Camera*>(camera)->getView() : nullptr;
    const bool goesOn = missing > 0 || plays, wentOn = known.goesOn.valid();
    known.missing = missing;
    known.goesOn = goesOn ? view : nullptr;
    pages.setState(viewId, frameOf(visitor), known);
    if (changed)
        if (const PagingCallback callback = getPagingCallback())
            callback({&voxels, camera, missing});
    if (view && (goesOn || wentOn)) Pages::setContinuous(*view);
}

} // namespace

void selectPages(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                 osgUtil::CullVisitor& visitor)
{
    if (!visitor.getProjectionMatrix()) return;
    const std::shared_ptr<Pages> pages = BrickResidency::of(voxels)->pages(voxels);
    const PageView view{toGlm(*volume.frameToEye), std::nullopt};
    const auto selection = [&](const TimeSteps& steps) {
        return PageSelection(volume, voxels, steps, view, hooks.skipping, pages, visitor);
    };
    // Steps that were begun with are waited for, or where time goes on faster than they can be read
    // none would ever be there.
    Pages::ViewState known = pages->stateOf(volume.viewId);
    const TimeSteps now = volume.steps;
    const bool waits =
        known.pending && known.pending->blended == now.blended && !known.pending->sameSteps(now);
    const TimeSteps aim = waits ? *known.pending : now;
    if (!known.shown || !known.shown->sameSteps(aim)) known.ahead = 1;
    PageSelection wanted = selection(aim);
    wanted.choose(PageSelection::TO_DRAW);
    std::optional<PageSelection> instead;
    const bool hasOthers = known.shown && !known.shown->sameSteps(aim);
    if (!wanted.isComplete() && hasOthers && known.shown->blended == aim.blended) {
        instead.emplace(selection(*known.shown));
        instead->choose(PageSelection::INSTEAD);
        if (!instead->isComplete()) instead.reset();
    }
    (instead ? *instead : wanted).draw();
    // Where nothing is drawn, nothing can be uploaded with it.
    if (instead && volume.bricks.empty()) {
        instead.reset();
        wanted.draw();
    }
    if (instead) volume.bricks.front().texels.uploads = wanted.uploads();
    if (wanted.isComplete()) known.shown = aim;
    known.pending.reset();
    if (!wanted.isComplete() && !wanted.hasFailed()) known.pending = aim;
    const std::int64_t missing = wanted.missing() + (aim.sameSteps(now) ? 0 : 1);
    const bool plays = voxels.getStepCount() > 1 && volume.appearance->getTimeRate() != 0.0;
    std::vector<PageRequest> requests;
    wanted.appendRequests(0, requests);
    const std::size_t own = requests.size();
    if (plays)
        appendStepsAhead(volume, aim, wanted.memoryBytes(), selection, known.ahead, requests);
    const auto later = viewAhead(volume, known.toEye, *visitor.getProjectionMatrix());
    if (requests.empty() && later)
        appendViewAhead({volume, voxels, aim, *later, hooks.skipping, pages, visitor}, requests);
    const std::size_t ahead = requests.size() - own;
    known.toEye = *volume.frameToEye;
    tell(voxels, missing, plays, volume.viewId, known, *pages, visitor);
    const std::int64_t waiting = pages->ask(volume.viewId, std::move(requests));
    wanted.report(missing, waiting, static_cast<std::int64_t>(ahead));
}

} // namespace render
} // namespace osgVolumizer
