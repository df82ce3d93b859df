#include "Renderer.h"

namespace osgVolumizer {

namespace {

Renderer*& installed()
{
    static Renderer* renderer = nullptr;
    return renderer;
}

} // namespace

void setRenderer(Renderer* renderer)
{
    installed() = renderer;
}

Renderer* getRenderer()
{
    return installed();
}

} // namespace osgVolumizer
