#include "FieldShaders.h"

#include <algorithm>
#include <mutex>
#include <vector>

namespace osgVolumizer {

namespace {

constexpr std::size_t MOST = 1024; // each is a program that stays

struct Known
{
    std::mutex mutex;
    std::vector<std::string> shaders{std::string()};
};

Known& known()
{
    static Known* const all = new Known; // nodes may outlive everything static
    return *all;
}

} // namespace

int fieldShaderNumber(const std::string& glsl)
{
    Known& all = known();
    std::lock_guard<std::mutex> lock(all.mutex);
    const auto found = std::find(all.shaders.begin(), all.shaders.end(), glsl);
    if (found == all.shaders.end() && all.shaders.size() >= MOST) return -1;
    const auto number = found - all.shaders.begin();
    if (found == all.shaders.end()) all.shaders.push_back(glsl);
    return static_cast<int>(number);
}

std::string fieldShader(int number)
{
    Known& all = known();
    std::lock_guard<std::mutex> lock(all.mutex);
    return all.shaders.at(static_cast<std::size_t>(number));
}

} // namespace osgVolumizer
