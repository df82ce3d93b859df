#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

/// The folder of the sources that the tests are built from.
inline const std::filesystem::path source = OSGVOLUMIZER_SOURCE_DIR;

/// All of a file; empty where it cannot be read.
inline std::string textOf(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}
