// osgvolumizerrender: a scene in, a picture and its statistics out, without a window.

#include "Arguments.h"
#include "StatsFile.h"

#include <support/PictureFile.h>
#include <support/ReadScene.h>
#include <support/SceneRenderer.h>

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/Version.h>

#include <osg/Math>
#include <osgUtil/Optimizer>

#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>

using namespace osgVolumizer;

namespace {

/// Sets what the command line says on every appearance.
class Apply : public osg::NodeVisitor
{
public:
    explicit Apply(const Arguments& arguments)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _arguments(arguments)
    {
    }
    void apply(osg::Group& group) override
    {
        if (auto* appearance = dynamic_cast<VolumeAppearance*>(&group))
            for (const auto& [property, values] : _arguments.properties)
                property->set(*appearance, values);
        traverse(group);
    }

private:
    const Arguments& _arguments;
};

support::RenderOptions viewOf(const Arguments& arguments, const osg::BoundingSphere& bound)
{
    support::RenderOptions options;
    options.size(arguments.width, arguments.height);
    options.background = arguments.background;
    options.light = true;
    if (arguments.orthographicHalfHeight)
        options.orthographic(*arguments.orthographicHalfHeight);
    else
        options.perspective(arguments.fovyDegrees.value_or(support::fieldOfViewOfViewers()));
    if (arguments.eye)
        options.lookAt(*arguments.eye, arguments.center.value_or(osg::Vec3d(bound.center())),
                       arguments.up.value_or(osg::Vec3d(0.0, 0.0, 1.0)));
    else
        options.frameScene(bound);
    return options;
}

/// Goes round the scene, frame by frame; the view is back in the end.
void turn(support::SceneRenderer& renderer, const Arguments& arguments,
          const osg::BoundingSphere& bound, Statistics& statistics)
{
    const osg::Matrixd view = renderer.options().view;
    const osg::Vec3d center = arguments.center.value_or(osg::Vec3d(bound.center()));
    const osg::Vec3d up = arguments.up.value_or(osg::Vec3d(0.0, 0.0, 1.0));
    for (int i = 1; i <= arguments.frames && renderer.status().ok(); ++i) {
        const double angle = osg::DegreesToRadians(i * arguments.turnDegrees);
        renderer.options().view = osg::Matrixd::translate(-center) *
                                  osg::Matrixd::rotate(angle, up) *
                                  osg::Matrixd::translate(center) * view;
        renderer.render();
        for (const double ms : renderer.milliseconds())
            statistics.milliseconds.push_back(ms);
        statistics.latestFrame = renderer.counters();
    }
    renderer.options().view = view;
}

/// Nobody looks at the frames before the last one: they need not be fast.
void uploadAtOnce()
{
    PagingBudget budget = getPagingBudget();
    budget.uploadMilliseconds = 1e9;
    setPagingBudget(budget);
}

/// Draws until nothing is missing of volumes that are read in the background.
Status waitForDetail(support::SceneRenderer& renderer, double seconds)
{
    const auto start = std::chrono::steady_clock::now();
    renderer.options().frames = 1;
    renderer.render(); // at rest, a view is exact from its second frame on
    while (renderer.status().ok()) {
        const auto counters = renderer.counters();
        const auto missing = counters.find("osgVolumizer pages missing");
        if (missing == counters.end() || missing->second == 0.0) return {};
        if (std::chrono::steady_clock::now() - start >= std::chrono::duration<double>(seconds))
            return Status(ErrorCode::FILE_UNREADABLE,
                          "The picture lacks detail: parts of a volume could not be read in time; "
                          "see --wait-for-detail.");
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        renderer.render();
    }
    return renderer.status();
}

/// A line for each device of EGL.
Status listDevices()
{
    const int count = support::OffscreenDisplay::deviceCount();
    if (count == 0) return Status(ErrorCode::NOT_SUPPORTED, "EGL lists no devices.");
    for (int i = 0; i < count; ++i) {
        const osg::ref_ptr<support::SurfacelessGraphicsContext> context =
            new support::SurfacelessGraphicsContext(1, 1, support::OffscreenContext::COMPATIBILITY,
                                                    i);
        context->realize();
        std::cout << i << "  "
                  << (context->valid() ? context->device().renderer : context->status().text)
                  << "\n";
    }
    return Status();
}

Status run(const Arguments& arguments)
{
    if (arguments.listDevices) return listDevices();
    std::optional<int> device;
    if (arguments.device) {
        const Result<int> number = support::OffscreenDisplay::parseDevice(*arguments.device);
        if (!number.ok()) return number.status;
        device = *number;
    }
    const Result<osg::ref_ptr<osg::Node>> read =
        support::readScene(arguments.scene, arguments.readerOptions);
    if (!read.ok()) return read.status;
    const osg::ref_ptr<osg::Node>& scene = *read;
    Apply apply(arguments);
    scene->accept(apply);
    osgUtil::Optimizer().optimize(scene.get());

    support::RenderOptions options = viewOf(arguments, scene->getBound());
    options.device = device;
    options.time = arguments.time;
    // Singular where the line of sight is along the up vector.
    if (!(std::abs(options.view(0, 0)) + std::abs(options.view(1, 0)) +
              std::abs(options.view(2, 0)) >
          0.5))
        return Status(ErrorCode::VALUE_INVALID,
                      "The line of sight is parallel to the up vector, or one of them is zero.");
    support::SceneRenderer renderer(scene.get(), options);
    Statistics statistics;
    uploadAtOnce();
    renderer.render();
    statistics.firstFrame = renderer.counters();
    // What is timed is to be all there.
    const auto missing = statistics.firstFrame.find("osgVolumizer pages missing");
    Status detail;
    if (missing != statistics.firstFrame.end() && missing->second > 0.0)
        detail = waitForDetail(renderer, arguments.waitSeconds);
    if (arguments.turnDegrees != 0.0) {
        turn(renderer, arguments, scene->getBound(), statistics);
    } else {
        renderer.options().frames = static_cast<unsigned>(arguments.frames);
        renderer.render();
        statistics.milliseconds = renderer.milliseconds();
        statistics.latestFrame = renderer.counters();
    }
    if (!renderer.status().ok()) return renderer.status();
    if (detail.ok()) detail = waitForDetail(renderer, arguments.waitSeconds);
    statistics.device = renderer.device();
    support::FloatImage image;
    if (!arguments.output.empty()) image = support::renderCoverage(renderer);
    if (!renderer.status().ok()) return renderer.status();

    Status status;
    if (!arguments.output.empty()) status = support::writePicture(image, arguments.output);
    if (status.ok() && !arguments.stats.empty()) status = writeStatistics(statistics, arguments);
    return status.ok() ? detail : status;
}

} // namespace

int main(int argc, char** argv)
{
    const Result<Arguments> arguments = parseArguments(argc, argv);
    if (!arguments.ok()) {
        std::cerr << "osgvolumizerrender: " << arguments.status.text << "\n";
        return 2;
    }
    if (arguments->help) {
        std::cout << usage();
        return 0;
    }
    if (arguments->version) {
        std::cout << "osgvolumizerrender " << getVersion() << "\n";
        return 0;
    }
    const Status status = run(*arguments);
    if (status.ok()) return 0;
    std::cerr << "osgvolumizerrender: " << status.text << "\n";
    return 1;
}
