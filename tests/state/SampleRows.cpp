// How fragments become values of a framebuffer.

#include "StateRow.h"

#include <osg/ClampColor>
#include <osg/Hint>
#include <osg/Multisample>
#include <osg/SampleMaski>

#ifndef GL_FRAMEBUFFER_SRGB
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#endif

namespace osgVolumizer {
namespace test {

namespace {

const char* const ONE_SAMPLE = "Volumes have one sample a pixel.";

void setSampleMask(osg::StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::SampleMaski> mask = new osg::SampleMaski;
    mask->setMask(0x5, 0);
    set.setAttributeAndModes(mask, value);
    set.setMode(GL_SAMPLE_MASK, value);
}

void setCoverage(osg::StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Multisample> multisample = new osg::Multisample;
    multisample->setSampleCoverage(0.5f, false);
    set.setAttributeAndModes(multisample, value);
    set.setMode(GL_SAMPLE_COVERAGE_ARB, value);
}

} // namespace

std::vector<StateRow> sampleRows()
{
    return {
        {"Multisample, `GL_SAMPLE_COVERAGE`", setCoverage, Effect::NONE, true, ONE_SAMPLE,
         Target::SAMPLES},
        {"SampleMaski", setSampleMask, Effect::NONE, true, ONE_SAMPLE, Target::SAMPLES},
        {"`GL_SAMPLE_ALPHA_TO_COVERAGE`", mode(GL_SAMPLE_ALPHA_TO_COVERAGE_ARB), Effect::NONE, true,
         ONE_SAMPLE, Target::SAMPLES},
        {"`GL_SAMPLE_ALPHA_TO_ONE`", mode(GL_SAMPLE_ALPHA_TO_ONE_ARB), Effect::NONE, true,
         ONE_SAMPLE, Target::SAMPLES},
        {"`GL_MULTISAMPLE` off", mode(GL_MULTISAMPLE_ARB, false), Effect::NONE, false, ONE_SAMPLE,
         Target::SAMPLES},
        {"ClampColor",
         with<osg::ClampColor>(GLenum(GL_TRUE), GLenum(GL_TRUE), GLenum(GL_FIXED_ONLY)),
         Effect::NONE, false, "Colours of tables lie in [0, 1]; what is between is not clamped."},
        {"`GL_FRAMEBUFFER_SRGB`", mode(GL_FRAMEBUFFER_SRGB), Effect::AS_ON_GEOMETRY, false,
         "Colours are linear; where the attachment is sRGB they are encoded when all is "
         "composited."},
        {"`GL_DITHER`", mode(GL_DITHER), Effect::NONE, false, "What is accumulated has 32 bits."},
        {"Hint", with<osg::Hint>(GLenum(GL_FOG_HINT), GLenum(GL_NICEST)), Effect::NONE, false,
         "Concerns what volumes do not use."},
    };
}

} // namespace test
} // namespace osgVolumizer
