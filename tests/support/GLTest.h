#pragma once

#include "Compare.h"

#include <support/SceneRenderer.h>

#include <gtest/gtest.h>

#include <cstdlib>

namespace osgVolumizer {
namespace support {

/// Base of the tests that need GL. Without GL they fail, unless OSGVOLUMIZER_ALLOW_SKIP_GL=1.
class GLTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const auto context = OffscreenContext::create();
        if (context.ok()) return;
        const char* allow = std::getenv("OSGVOLUMIZER_ALLOW_SKIP_GL");
        if (allow && std::string(allow) == "1") GTEST_SKIP() << context.status.text;
        FAIL() << context.status.text
               << " Set OSGVOLUMIZER_ALLOW_SKIP_GL=1 to skip the tests that need one.";
    }
};

} // namespace support
} // namespace osgVolumizer
