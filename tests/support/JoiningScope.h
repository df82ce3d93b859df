#pragma once

#include <osgVolumizer/render/cull/BrickJoining.h>

namespace osgVolumizer {
namespace support {

/// Whether bricks may be joined in one texture, for as long as it lives.
class JoiningScope
{
public:
    explicit JoiningScope(bool on) { render::setJoining(on); }
    ~JoiningScope() { render::setJoining(true); }
    JoiningScope(const JoiningScope&) = delete;
    JoiningScope& operator=(const JoiningScope&) = delete;
};

} // namespace support
} // namespace osgVolumizer
