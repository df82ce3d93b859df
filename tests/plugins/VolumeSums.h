#pragma once

#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/io/Placement.h>

#include <gtest/gtest.h>
#include <osg/Notify>

#include <string>
#include <vector>

/// What was read of a volume, to compare with numbers that another program found.
struct VolumeSums
{
    glm::ivec3 size{0};
    std::string type;
    int components = 0, steps = 0;
    double sum = 0.0;
    double weighted = 0.0; ///< value i, x fastest, then y, z and time, times i modulo 1021 + 1
    /// Where it lies: of sample 0, and the step of each axis.
    glm::dvec3 position{0.0}, axes[3];
};

/// All values, x fastest, steps one behind the other.
inline std::vector<double> valuesOf(const osgVolumizer::VoxelSource& source)
{
    using namespace osgVolumizer;
    const VoxelSource::Description d = source.describe();
    std::vector<double> values;
    std::vector<char> bytes(static_cast<std::size_t>(d.sizeInBytes()));
    for (int step = 0; step < source.stepCount(); ++step) {
        const Status status = source.readStep(step, 0, {glm::ivec3(0), d.size}, bytes.data());
        EXPECT_TRUE(status.ok()) << status.text;
        const core::VoxelView view{bytes.data(), d.type, d.components, d.size};
        for (std::int64_t i = 0; i < core::sampleCount(d.size); ++i)
            for (int c = 0; c < d.components; ++c)
                values.push_back(core::voxelValue(view, i, c));
    }
    return values;
}

inline VolumeSums sumsOf(const osgVolumizer::VoxelSource& source)
{
    using namespace osgVolumizer;
    const VoxelSource::Description d = source.describe();
    VolumeSums sums;
    sums.size = d.size;
    sums.type = voxelTypeName(d.type);
    sums.components = d.components;
    sums.steps = source.stepCount();
    std::size_t i = 0;
    for (const double v : valuesOf(source)) {
        sums.sum += v;
        sums.weighted += v * double(i++ % 1021 + 1);
    }
    sums.position = io::placeOf(d, glm::dvec3(0.0));
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 next(0.0);
        next[axis] = 1.0;
        sums.axes[axis] = io::placeOf(d, next) - sums.position;
    }
    return sums;
}

/// What is told at OSG_NOTICE while it lives.
class Notices
{
public:
    Notices() : _before(osg::getNotifyHandler()), _heard(new Heard)
    {
        osg::setNotifyHandler(_heard);
    }
    ~Notices() { osg::setNotifyHandler(_before); }
    Notices(const Notices&) = delete;
    Notices& operator=(const Notices&) = delete;

    const std::string& text() const { return _heard->all; }
    bool has(const std::string& part) const { return text().find(part) != std::string::npos; }

private:
    struct Heard : osg::NotifyHandler
    {
        void notify(osg::NotifySeverity, const char* text) override { all += text; }
        std::string all;
    };
    osg::ref_ptr<osg::NotifyHandler> _before;
    osg::ref_ptr<Heard> _heard;
};
