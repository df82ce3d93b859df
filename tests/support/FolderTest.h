#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace osgVolumizer {
namespace support {

/// Base of the tests that write files: each has a fresh folder, which is removed afterwards.
class FolderTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        _folder = std::filesystem::path(::testing::TempDir()) /
                  (std::string("osgVolumizer") + test->test_suite_name() + test->name());
        std::filesystem::remove_all(_folder);
        std::filesystem::create_directories(_folder);
    }
    void TearDown() override { std::filesystem::remove_all(_folder); }

    const std::filesystem::path& folder() const { return _folder; }
    std::string path(const std::string& name) const { return (_folder / name).string(); }
    std::string writeBytes(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

private:
    std::filesystem::path _folder;
};

} // namespace support
} // namespace osgVolumizer
