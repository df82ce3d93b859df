#pragma once

namespace osgVolumizer {
namespace render {

/// What a context cannot do, or has no memory for, and is composed without from the next frame on.
enum class Refusal : unsigned
{
    CAPTURED_SURFACES = 1,
    RANKED_SURFACES = 2,
    FUSED_VOLUMES = 4
};

/// For cull threads, which have no context. Thread safe.
void refuse(unsigned contextId, Refusal what);
bool isRefused(unsigned contextId, Refusal what);
/// When the context's resources go.
void forgetRefusals(unsigned contextId);

} // namespace render
} // namespace osgVolumizer
