// What is no regular file is refused before it is opened: a pipe would be waited for, and a device
// read for ever. A watchdog ends the program where that happens.

#include "../support/Watchdog.h"

#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/WriteVoxels.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace SpecialFilesTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

class SpecialFiles : public testing::Test
{
protected:
    SpecialFiles()
    {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        _folder = fs::path(testing::TempDir()) / ("osgVolumizerSpecial" + name);
        fs::remove_all(_folder);
        fs::create_directories(_folder);
    }
    ~SpecialFiles() override { fs::remove_all(_folder); }

    std::string path(const std::string& name) const { return (_folder / name).string(); }
    std::string makePipe(const std::string& name) const
    {
        EXPECT_EQ(mkfifo(path(name).c_str(), 0600), 0) << name;
        return path(name);
    }
    std::string makeLink(const std::string& name, const std::string& target) const
    {
        fs::create_symlink(target, path(name));
        return path(name);
    }
    std::string makeSocket(const std::string& name) const
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string target = path(name);
        EXPECT_LT(target.size(), sizeof(address.sun_path));
        target.copy(address.sun_path, sizeof(address.sun_path) - 1);
        const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
        EXPECT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
        close(socket);
        return target;
    }
    static void expectNoRegularFile(const Status& status, const std::string& path)
    {
        EXPECT_EQ(status.code, ErrorCode::FILE_UNREADABLE) << path;
        EXPECT_NE(status.text.find(path + " is no regular file"), std::string::npos) << status.text;
    }

    support::Watchdog _watchdog;
    fs::path _folder;
};

TEST_F(SpecialFiles, AsVoxels)
{
    for (const std::string& name :
         {makePipe("pipe"), makePipe("pipe.tif"), makePipe("pipe.dcm"), makePipe("pipe.vdb"),
          makeLink("link.tif", path("pipe.tif")), makeLink("zero.tif", "/dev/zero"),
          makeSocket("socket.tif"), std::string("/dev/zero")}) {
        expectNoRegularFile(readVoxels(name).status, name);
        expectNoRegularFile(readVolume(name).status, name);
    }
}

TEST_F(SpecialFiles, AsRawVoxels)
{
    for (const std::string& name :
         {makePipe("pipe.raw"), makeLink("link.raw", path("pipe.raw")),
          makeLink("zero.raw", "/dev/zero"), makeSocket("socket.raw"), std::string("/dev/zero")})
        expectNoRegularFile(readVoxels(name + ".2,2,2,uint8").status, name);
    fs::create_directory(path("folder.raw"));
    expectNoRegularFile(readVoxels(path("folder.raw") + ".2,2,2,uint8").status, path("folder.raw"));
}

TEST_F(SpecialFiles, AsSlices)
{
    for (const std::string& name : {makePipe("pipe.png"), std::string("/dev/zero")}) {
        expectNoRegularFile(readSlices({name}).status, name);
        expectNoRegularFile(readSlices({name, name}).status, name);
    }
    fs::create_directory(path("folder.png"));
    expectNoRegularFile(readSlices({path("folder.png")}).status, path("folder.png"));
    // Folders and patterns pass over what is no file.
    const Status folder = readVoxels(_folder.string()).status;
    EXPECT_NE(folder.text.find("has no images"), std::string::npos) << folder.text;
    makePipe("slice1.png");
    EXPECT_EQ(readVoxels(path("slice%d.png")).status.code, ErrorCode::FILE_NOT_FOUND);
}

TEST_F(SpecialFiles, AsTable)
{
    fs::create_directory(path("folder.lut"));
    for (const std::string& name :
         {makePipe("pipe.lut"), makePipe("pipe.tf"), makeLink("link.lut", path("pipe.lut")),
          makeLink("zero.lut", "/dev/zero"), makeSocket("socket.lut"), path("folder.lut"),
          std::string("/dev/zero")})
        expectNoRegularFile(readLookupTable(name).status, name);
}

// A pipe would be waited for, and what is renamed to a device takes its place.
TEST_F(SpecialFiles, AreNotWrittenTo)
{
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    VoxelSource::Description description;
    description.size = glm::ivec3(2);
    ASSERT_TRUE(source->allocate(description));
    const std::string image = makePipe("pipe.tif"), table = makePipe("pipe.lut");
    expectNoRegularFile(writeVoxels(*source, image), image);
    EXPECT_TRUE(fs::is_fifo(image));
    const osg::ref_ptr<LookupTable> ramp = new LookupTable;
    expectNoRegularFile(writeLookupTable(*ramp, table), table);
    EXPECT_TRUE(writeLookupTable(*ramp, path("new.lut")));
    EXPECT_TRUE(writeLookupTable(*ramp, path("new.lut"))); // over the old one
    EXPECT_TRUE(readLookupTable(path("new.lut")).ok());
}

} // namespace

} // namespace SpecialFilesTest
