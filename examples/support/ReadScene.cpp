#include "ReadScene.h"

#include <osg/Notify>
#include <osgDB/Registry>

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace support {

namespace {

/// While one lives, warnings and errors of OSG are kept here instead of printed.
class Warnings
{
public:
    Warnings() : _before(osg::getNotifyHandler()), _level(osg::getNotifyLevel())
    {
        osg::notify(_level).flush();
        osg::setNotifyHandler(_collector);
        osg::setNotifyLevel(std::max(_level, osg::WARN));
    }
    ~Warnings()
    {
        osg::notify(osg::WARN).flush();
        osg::setNotifyLevel(_level);
        osg::setNotifyHandler(_before);
    }
    Warnings(const Warnings&) = delete;
    Warnings& operator=(const Warnings&) = delete;

    /// The first one, and how many others there are; empty where there is none.
    std::string text() const
    {
        osg::notify(osg::WARN).flush();
        const std::vector<std::string>& all = _collector->texts;
        if (all.size() < 2) return all.empty() ? "" : all.front();
        return all.front() + " (and " + std::to_string(all.size() - 1) + " more)";
    }

private:
    struct Collector : osg::NotifyHandler
    {
        explicit Collector(osg::NotifyHandler* handler) : next(handler) {}
        void notify(osg::NotifySeverity severity, const char* message) override
        {
            if (severity > osg::WARN) {
                if (next) next->notify(severity, message);
                return;
            }
            std::string text = message;
            std::replace(text.begin(), text.end(), '\n', ' ');
            text.erase(text.find_last_not_of(" .") + 1);
            if (!text.empty() && std::find(texts.begin(), texts.end(), text) == texts.end())
                texts.push_back(text);
        }
        osg::ref_ptr<osg::NotifyHandler> next;
        std::vector<std::string> texts;
    };

    osg::ref_ptr<osg::NotifyHandler> _before;
    osg::NotifySeverity _level;
    osg::ref_ptr<Collector> _collector = new Collector(_before);
};

Status unreadable(const std::string& text)
{
    return Status(ErrorCode::FILE_UNREADABLE, text + ".");
}

} // namespace

Result<osg::ref_ptr<osg::Node>> readScene(const std::string& fileName,
                                          const std::string& readerOptions)
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(readerOptions);
    const Warnings warnings;
    osgDB::ReaderWriter::ReadResult read =
        osgDB::Registry::instance()->readNode(fileName, options.get());
    const osg::ref_ptr<osg::Node> scene = read.getNode();
    const std::string said = warnings.text();
    if (!scene) {
        // A reader that gives its reason often has printed the same.
        const bool known = said.empty() || !read.message().empty();
        return unreadable("Cannot read a scene from '" + fileName + "': " + read.statusMessage() +
                          (known ? "" : "; " + said));
    }
    if (!said.empty()) return unreadable("Cannot read all of '" + fileName + "': " + said);
    return scene;
}

} // namespace support
} // namespace osgVolumizer
