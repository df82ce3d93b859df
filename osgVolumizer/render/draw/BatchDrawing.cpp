#include "BatchDrawing.h"

#include "../context/Allocation.h"
#include "../context/ReportOnce.h"
#include "../context/Uniforms.h"
#include "../textures/BrickCells.h"
#include "../textures/JoinedBricks.h"
#include "VisibilityQueries.h"

#include "../../core/ordering/BrickOrder.h"
#include "../../core/sampling/ViewHelpers.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <map>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// False where there is nothing to draw from. Bricks of both steps have the same samples, and so are
// coarser in the same way where they have to be.
bool setNextStep(const BatchDrawing& drawing, const BrickBatch& batch)
{
    drawing.uniforms.set("stepFraction", batch.stepFraction);
    return batch.nextBrick.texture &&
           batch.nextBrick.apply(drawing.renderInfo, drawing.limits, drawing.nextVoxelUnit).texture;
}

// False where there is nothing to draw from.
bool setVoxels(const BatchDrawing& drawing, const BrickBatch& batch)
{
    CoarseTexture voxels;
    if (batch.joined) {
        if (!batch.joined->apply(drawing.renderInfo, drawing.limits, drawing.voxelUnit))
            return false;
    } else if (batch.brick.texture) {
        voxels = batch.brick.apply(drawing.renderInfo, drawing.limits, drawing.voxelUnit);
        if (!voxels.texture) return false;
        if (drawing.features.blendsSteps && !setNextStep(drawing, batch)) return false;
    } else {
        return true;
    }
    drawing.uniforms.set("textureScale", batch.textureScale * voxels.scale);
    drawing.uniforms.set("textureOffset", batch.textureOffset * voxels.scale + voxels.offset);
    return true;
}

void setCells(const BatchDrawing& drawing, const BrickCells* cells)
{
    osg::State& state = *drawing.renderInfo.getState();
    bool known = cells && cells->texture;
    if (known &&
        !applyAllocated(state, AllocationRequest::CELLS, *cells->texture, drawing.cellUnit)) {
        known = false;
        reportOnce({ErrorCode::TOO_LARGE, "what is empty in a brick is refused by the graphics "
                                          "card; nothing of the brick is leapt over"});
    }
    if (!known) state.applyTextureAttribute(drawing.cellUnit, occupiedEverywhere());
    drawing.uniforms.set("cellOrigin", known ? cells->origin : glm::vec3(0.0f));
    drawing.uniforms.set("cellSize", known ? cells->cellSize : 1e6f);
}

// The batch of a brick that was to be drawn as part of joined ones: the same triangles, cut by the
// shader.
BrickBatch apartBatch(const BrickBatch& joined, const SelectedBrick& brick)
{
    BrickBatch batch = batchOf(brick);
    batch.clipMin = glm::max(joined.clipMin, batch.clipMin);
    batch.clipMax = glm::min(joined.clipMax, batch.clipMax);
    batch.firstIndex = joined.firstIndex;
    batch.indexCount = joined.indexCount;
    return batch;
}

void drawApart(const BatchDrawing& drawing, const BrickBatch& batch)
{
    const JoinedBricks& joined = *batch.joined;
    const Result<glm::dvec4> eye = core::eyePosition(drawing.view);
    if (!eye) return;
    std::vector<std::int64_t> order;
    std::map<std::int64_t, const SelectedBrick*> byIndex;
    for (const SelectedBrick& brick : joined.apart) {
        order.push_back(brick.index);
        byIndex[brick.index] = &brick;
    }
    core::BrickOrder(joined.voxels->getLayout()).sort(*eye, order);
    for (const std::int64_t index : order)
        drawBatch(drawing, apartBatch(batch, *byIndex.at(index)));
}

} // namespace

BrickBatch batchOf(const SelectedBrick& brick)
{
    BrickBatch batch;
    batch.brick = brick.texels;
    batch.nextBrick = brick.nextTexels;
    batch.stepFraction = brick.stepFraction;
    batch.clipMin = glm::vec3(brick.box.min);
    batch.clipMax = glm::vec3(brick.box.max);
    batch.brickMin = glm::vec3(brick.clipBox.min);
    batch.brickMax = glm::vec3(brick.clipBox.max);
    batch.cells = brick.cells;
    batch.stride = brick.cells && brick.cells->homogeneous ? ALL_STEPS : brick.stride;
    batch.joined = brick.joined;
    batch.textureScale = brick.textureScale;
    batch.textureOffset = brick.textureOffset;
    return batch;
}

bool setBatch(const BatchDrawing& drawing, const BrickBatch& batch)
{
    const Uniforms& uniforms = drawing.uniforms;
    if (!setVoxels(drawing, batch)) return false;
    if (drawing.features.skipping) setCells(drawing, batch.cells.get());
    if (drawing.features.preIntegrated) {
        uniforms.set("brickMin", batch.brickMin);
        uniforms.set("brickMax", batch.brickMax);
    }
    // What is the same everywhere is not in fog, nor by colours of vertices.
    const ProgramFeatures& features = drawing.features;
    const bool varies = features.fog || features.vertexColors || features.fieldCount > 0;
    const bool fades = varies && batch.stride == ALL_STEPS;
    uniforms.set("stride", fades ? 1.0f : batch.stride);
    uniforms.set("clipMin", batch.clipMin);
    uniforms.set("clipMax", batch.clipMax);
    return true;
}

void drawBatch(const BatchDrawing& drawing, const BrickBatch& batch)
{
    if (glm::any(glm::greaterThan(batch.clipMin, batch.clipMax))) return;
    if (!setBatch(drawing, batch)) {
        if (batch.joined) drawApart(drawing, batch);
        return;
    }
    const auto draw = [&batch]() {
        glDrawElements(
            GL_TRIANGLES, static_cast<GLsizei>(batch.indexCount), GL_UNSIGNED_INT,
            reinterpret_cast<const void*>(std::size_t(batch.firstIndex) * sizeof(unsigned)));
    };
    const std::shared_ptr<VisibilityTest>& test = batch.brick.test;
    if (!drawing.tests || !test) return draw();
    test->setOpaque();
    if (batch.brick.testedAs < 0) return draw();
    osg::State& state = *drawing.renderInfo.getState();
    auto& queries = drawing.tests->part<VisibilityQueries>();
    queries.begin(state, test, batch.brick.testedAs);
    draw();
    queries.end(state);
}

} // namespace render
} // namespace osgVolumizer
