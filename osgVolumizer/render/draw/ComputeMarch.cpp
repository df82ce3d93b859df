#include "ComputeMarch.h"

#include "../context/March.h"
#include "../context/ScissorScope.h"
#include "../context/Uniforms.h"
#include "AccumulationBuffers.h"
#include "FusedVolumes.h"
#include "VolumeProgram.h"

#include <map>
#include <optional>

namespace osgVolumizer {
namespace render {

namespace {

// Compiled in one context: what its compiler says of them is for it alone.
struct ComputePrograms : ContextPart
{
    std::map<std::vector<std::uint64_t>, osg::ref_ptr<osg::Program>> programs;

    void release(osg::GLExtensions&) override {}
};

const char* glslFormat(GLenum format)
{
    switch (format) {
    case GL_RGBA32F_ARB:
        return "rgba32f";
    case GL_RGBA16F_ARB:
        return "rgba16f";
    case GL_RGBA16:
        return "rgba16";
    case GL_RGBA8:
        return "rgba8";
    }
    return nullptr;
}

osg::Program& programOf(osg::State& state, ContextResources& resources, const VolumePart& part,
                        GLenum format)
{
    const std::vector<ProgramFeatures> members = membersOf(part);
    std::vector<std::uint64_t> key{format, part.features.key(), part.features.fieldKey()};
    for (const ProgramFeatures& member : members)
        key.insert(key.end(), {member.key(), member.fieldKey()});
    osg::ref_ptr<osg::Program>& program = resources.part<ComputePrograms>().programs[key];
    if (!program)
        program = makeComputeProgram(computeHeader(state) + "#define TARGET_FORMAT " +
                                         glslFormat(format) + "\n",
                                     part.features, members);
    return *program;
}

// The depths between which all of a mesh is marched; none where it has several slabs, far to near.
std::optional<glm::vec2> slabOf(const VolumeMesh& mesh)
{
    const std::vector<float>& vertices = mesh.vertexArray();
    if (mesh.slabOffset < 0 || vertices.empty()) return std::nullopt;
    const auto at = [&](std::size_t first) {
        const std::size_t i = first + static_cast<std::size_t>(mesh.slabOffset);
        return glm::vec2(vertices[i], vertices[i + 1]);
    };
    for (std::size_t i = 0; i < vertices.size(); i += static_cast<std::size_t>(mesh.stride))
        if (at(i) != at(0)) return std::nullopt;
    return at(0);
}

// Of several batches each would wait for the one before.
bool isOneMarch(const VolumePart& part, const VolumeMesh& mesh)
{
    const ProgramFeatures& features = part.features;
    return mesh.batches.size() == 1 && features.slab && !features.coarse && !features.gathers() &&
           !features.splitDepth && !features.ranked && part.above.isUsual() &&
           part.covered[2] > 0 && part.covered[3] > 0;
}

bool isDrawnTo(const AccumulationBuffers& buffers)
{
    GLint framebuffer = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING_EXT, &framebuffer);
    return buffers.framebuffer && GLuint(framebuffer) == buffers.framebuffer && buffers.color &&
           glslFormat(buffers.colorFormat);
}

// Where fragments would be: of a viewport that ends at pixels.
std::optional<glm::ivec4> wholeViewport()
{
    glm::vec4 v;
    glGetFloatv(GL_VIEWPORT, &v[0]);
    const glm::ivec4 whole{v};
    if (glm::vec4(whole) != v) return std::nullopt;
    return whole;
}

} // namespace

ComputeMarch::ComputeMarch(osg::State& state, ContextResources& resources, const VolumePart& part,
                           const VolumeMesh& mesh, bool coarse)
    : _state(state), _resources(resources), _part(part), _mesh(mesh)
{
    const AccumulationBuffers& buffers = resources.part<AccumulationBuffers>();
    if (coarse || !isOneMarch(part, mesh)) return;
    if (part.features.needsSortedSurfaces() && !buffers.sortedSurfaces[0]) return;
    if (marchOf(state, resources) != March::COMPUTE || !isDrawnTo(buffers)) return;
    const std::optional<glm::ivec4> viewport = wholeViewport();
    const std::optional<glm::vec2> slab = slabOf(mesh);
    if (!viewport || !slab) return;
    _viewport = *viewport;
    _slab = *slab;
    osg::Program& program = programOf(state, resources, part, buffers.colorFormat);
    _before = std::make_unique<AttributeScope>(state, osg::StateAttribute::PROGRAM);
    state.applyAttribute(&program);
    const auto* made = program.getPCP(state);
    if (made && made->isLinked() && state.getLastAppliedProgramObject() == made) return;
    leave();
    refuseCompute(resources, "the context's compiler refuses a compute shader");
}

std::vector<glm::ivec4> ComputeMarch::areas() const
{
    const AccumulationBuffers& buffers = _resources.part<AccumulationBuffers>();
    glm::ivec4 within = intersection(_viewport, {0, 0, buffers.width, buffers.height});
    if (glIsEnabled(GL_SCISSOR_TEST)) {
        glm::ivec4 box;
        glGetIntegerv(GL_SCISSOR_BOX, &box[0]);
        within = intersection(within, box);
    }
    std::vector<glm::ivec4> result;
    for (const glm::ivec4& rectangle :
         _part.scissors.empty() ? std::vector<glm::ivec4>{_part.covered} : _part.scissors) {
        const glm::ivec4 area = intersection(rectangle, within);
        if (area[2] > 0 && area[3] > 0) result.push_back(area);
    }
    return result;
}

bool ComputeMarch::draw(const BatchDrawing& drawing)
{
    const AccumulationBuffers& buffers = _resources.part<AccumulationBuffers>();
    const BrickBatch& batch = _mesh.batches.front();
    if (glm::any(glm::greaterThan(batch.clipMin, batch.clipMax))) return true;
    if (!setBatch(drawing, batch)) return false;
    drawing.uniforms.set("slabEnds", _slab);
    for (const glm::ivec4& area : areas()) {
        drawing.uniforms.set("area", glm::vec4(area));
        runCompute(_state, *buffers.color, buffers.colorFormat, area[2], area[3]);
    }
    return true;
}

} // namespace render
} // namespace osgVolumizer
