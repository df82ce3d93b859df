#pragma once

#include "UserObject.h"

#include <osg/Camera>
#include <osg/View>

namespace osgVolumizer {
namespace render {

/// What tests and measurements change about the volumes of one view: a user object of its camera.
class ViewHooks : public osg::Object
{
public:
    bool skipping = true; ///< leave out parts of bricks that show nothing
    bool joining = true;  ///< draw bricks as one where that is faster
    /// Slabs draw how many samples they take, added up in the red channel of a float framebuffer,
    /// instead of colours.
    bool countSamples = false;
    /// What views that move reduce the number of samples by, whatever time they take; 0: by time.
    double reduction = 0.0;

    ViewHooks() = default;
    ViewHooks(const ViewHooks& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(o, op), skipping(o.skipping), joining(o.joining),
          countSamples(o.countSamples), reduction(o.reduction)
    {
    }
    META_Object(osgVolumizer, ViewHooks);

    /// Those of a camera, or of the view that it is a slave of; all defaults where there are none.
    static const ViewHooks& of(const osg::Camera* camera)
    {
        static const osg::ref_ptr<const ViewHooks> defaults = new ViewHooks;
        const ViewHooks* hooks = userObject<ViewHooks>(camera);
        if (!hooks && camera && camera->getView())
            hooks = userObject<ViewHooks>(camera->getView()->getCamera());
        return hooks ? *hooks : *defaults;
    }
};

} // namespace render
} // namespace osgVolumizer
