#include "SurfacelessGraphicsContext.h"

namespace osgVolumizer {
namespace support {

SurfacelessGraphicsContext::SurfacelessGraphicsContext(int width, int height,
                                                       OffscreenContext::Profile profile)
{
    initialize(width, height, OffscreenContext::create(profile));
}

SurfacelessGraphicsContext::SurfacelessGraphicsContext(int width, int height,
                                                       const SurfaceFormat& format)
{
    initialize(width, height, OffscreenContext::createWithSurface(width, height, format));
}

void SurfacelessGraphicsContext::initialize(int width, int height,
                                            Result<std::unique_ptr<OffscreenContext>> context)
{
    _traits = new osg::GraphicsContext::Traits;
    _traits->x = _traits->y = 0;
    _traits->width = width;
    _traits->height = height;
    _traits->doubleBuffer = false;
    _traits->windowDecoration = false;

    _status = context.status;
    _context = std::move(context.value);

    setState(new osg::State);
    getState()->setGraphicsContext(this);
    getState()->setContextID(osg::GraphicsContext::createNewContextID());
    // OSG would take errors off, tell of them, and go on; they are for who reads pictures back.
    getState()->setCheckForGLErrors(osg::State::NEVER_CHECK_GL_ERRORS);
}

SurfacelessGraphicsContext::~SurfacelessGraphicsContext()
{
    close(true);
}

bool SurfacelessGraphicsContext::realizeImplementation()
{
    _realized = valid();
    return _realized;
}

void SurfacelessGraphicsContext::closeImplementation()
{
    _realized = false;
    _context.reset();
}

bool SurfacelessGraphicsContext::makeCurrentImplementation()
{
    return _context && _context->makeCurrent();
}

bool SurfacelessGraphicsContext::makeContextCurrentImplementation(osg::GraphicsContext*)
{
    return makeCurrentImplementation();
}

bool SurfacelessGraphicsContext::releaseContextImplementation()
{
    return _context && _context->release();
}

bool SurfacelessGraphicsContext::isSameKindAs(const Object* object) const
{
    return dynamic_cast<const SurfacelessGraphicsContext*>(object) != nullptr;
}

} // namespace support
} // namespace osgVolumizer
