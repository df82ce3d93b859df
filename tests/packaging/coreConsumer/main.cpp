// Uses the core library as a program without OpenSceneGraph would.
#include <osgVolumizer/core/geometry/TetraSet.h>
#include <osgVolumizer/core/voxels/BrickLayout.h>

#include <cstdio>

int main()
{
    using namespace osgVolumizer;
    const auto layout = core::BrickLayout::create(glm::ivec3(100), glm::ivec3(64));
    if (!layout.ok() || layout->brickCount() != 8) {
        std::fprintf(stderr, "100 voxels in bricks of 64: %s\n", layout.status.text.c_str());
        return 1;
    }
    core::TetraSet tetra;
    tetra.vertices.resize(4);
    tetra.indices = {0, 1, 2, 4};
    if (tetra.validate().code != ErrorCode::INDEX_OUT_OF_RANGE) {
        std::fprintf(stderr, "Index 4 of 4 vertices was accepted\n");
        return 1;
    }
    return 0;
}
