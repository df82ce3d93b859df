#include "SurfacelessGraphicsContext.h"

namespace osgVolumizer {
namespace support {

SurfacelessGraphicsContext::SurfacelessGraphicsContext(int width, int height,
                                                       OffscreenContext::Profile profile,
                                                       std::optional<int> device)
{
    initialize(width, height, OffscreenContext::create(profile, nullptr, device));
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
    if (!makeCurrentImplementation()) return false;
    if (const GLubyte* renderer = glGetString(GL_RENDERER))
        _device.renderer = reinterpret_cast<const char*>(renderer);
    _device.platform = _context->display().platform();
    _device.number = _context->display().device();
    if (_window) bindWindow();
    releaseContextImplementation();
    _realized = true;
    return true;
}

// It stays bound: OSG binds what is the default one after each framebuffer object.
void SurfacelessGraphicsContext::bindWindow()
{
    getState()->initializeExtensionProcs();
    _window->apply(*getState());
    setDefaultFboId(_window->getHandle(getState()->getContextID()));
}

void SurfacelessGraphicsContext::closeImplementation()
{
    _realized = false;
    _window = nullptr; // while what it frees can still be told from what a later context has
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
