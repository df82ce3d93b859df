#pragma once

#include <osgVolumizer/render/context/ContextHooks.h>
#include <osgVolumizer/render/context/ViewHooks.h>

#include <support/SceneRenderer.h>

#include <functional>

namespace osgVolumizer {
namespace support {

/// The user object of a class, which is made where the object has none.
template <class T>
T& userObject(osg::Object& object)
{
    if (const T* found = render::userObject<T>(&object)) return const_cast<T&>(*found);
    osg::ref_ptr<T> made = new T;
    object.getOrCreateUserDataContainer()->addUserObject(made);
    return *made;
}

/// What is changed about a viewer's volumes, and about its context. Between frames, of viewers of
/// one thread.
inline render::ViewHooks& viewHooks(osgViewer::Viewer& viewer)
{
    return userObject<render::ViewHooks>(*viewer.getCamera());
}
inline render::ContextHooks& contextHooks(osgViewer::Viewer& viewer)
{
    return userObject<render::ContextHooks>(*viewer.getCamera()->getGraphicsContext());
}

/// The same view, prepared by one more function.
inline RenderOptions prepared(RenderOptions options,
                              const std::function<void(osgViewer::Viewer&)>& prepare)
{
    const auto before = options.prepare;
    options.prepare = [before, prepare](osgViewer::Viewer& viewer) {
        if (before) before(viewer);
        prepare(viewer);
    };
    return options;
}

/// The same view, with bricks joined in one texture where that is faster, or never.
inline RenderOptions joining(const RenderOptions& options, bool on)
{
    return prepared(options, [on](osgViewer::Viewer& viewer) { viewHooks(viewer).joining = on; });
}

/// The same view, whose red channel has numbers of samples instead of colours.
inline RenderOptions countingSamples(const RenderOptions& options)
{
    return prepared(options,
                    [](osgViewer::Viewer& viewer) { viewHooks(viewer).countSamples = true; });
}

/// The same view, in a context whose card refuses some of what it is asked for.
inline RenderOptions
refusing(const RenderOptions& options,
         const std::function<bool(const render::AllocationRequest&)>& isRefused)
{
    return prepared(options, [isRefused](osgViewer::Viewer& viewer) {
        contextHooks(viewer).refuses = isRefused;
    });
}

/// The same view, in a context that can do something else.
inline RenderOptions limited(const RenderOptions& options,
                             const std::function<void(render::ContextLimits&)>& change)
{
    return prepared(options, [change](osgViewer::Viewer& viewer) {
        contextHooks(viewer).changeLimits = change;
    });
}

} // namespace support
} // namespace osgVolumizer
