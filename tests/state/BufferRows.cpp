// Buffers bound to a number.

#include "StateRow.h"

#include <osg/Array>
#include <osg/BufferIndexBinding>
#include <osg/BufferObject>

namespace osgVolumizer {
namespace test {

namespace {

const char* const OWN_BUFFERS = "Buffers belong to programs, and a volume has its own.";

template <class Binding, class Object>
void bindBuffer(osg::StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::FloatArray> data = new osg::FloatArray(64);
    data->setBufferObject(new Object);
    set.setAttribute(new Binding(0u, data.get(), 0, 256), value);
}

} // namespace

std::vector<StateRow> bufferRows()
{
    return {
        {"UniformBufferBinding", bindBuffer<osg::UniformBufferBinding, osg::UniformBufferObject>,
         Effect::NONE, false, OWN_BUFFERS},
        {"ShaderStorageBufferBinding",
         bindBuffer<osg::ShaderStorageBufferBinding, osg::ShaderStorageBufferObject>, Effect::NONE,
         false, OWN_BUFFERS},
        {"AtomicCounterBufferBinding",
         bindBuffer<osg::AtomicCounterBufferBinding, osg::AtomicCounterBufferObject>, Effect::NONE,
         false, OWN_BUFFERS},
        {"TransformFeedbackBufferBinding",
         bindBuffer<osg::TransformFeedbackBufferBinding, osg::VertexBufferObject>, Effect::NONE,
         false, OWN_BUFFERS},
    };
}

const std::vector<StateRow>& stateRows()
{
    static const std::vector<StateRow> rows = []() {
        std::vector<StateRow> all;
        for (const auto& part : {fragmentRows(), sampleRows(), primitiveRows(), spaceRows(),
                                 shadingRows(), textureRows(), bufferRows()})
            all.insert(all.end(), part.begin(), part.end());
        return all;
    }();
    return rows;
}

} // namespace test
} // namespace osgVolumizer
