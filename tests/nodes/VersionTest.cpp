#include <osgVolumizer/Version.h>

#include <gtest/gtest.h>

#include <string>

namespace VersionTest {

TEST(Version, OfTheLibraryIsTheHeaders)
{
    EXPECT_STREQ(osgVolumizer::getVersion(), OSGVOLUMIZER_VERSION);
    EXPECT_EQ(std::string(OSGVOLUMIZER_VERSION), std::to_string(OSGVOLUMIZER_VERSION_MAJOR) + "." +
                                                     std::to_string(OSGVOLUMIZER_VERSION_MINOR) +
                                                     "." +
                                                     std::to_string(OSGVOLUMIZER_VERSION_PATCH));
}

TEST(Version, NumbersCompareAsVersionsDo)
{
    static_assert(OSGVOLUMIZER_VERSION_MINOR < 100 && OSGVOLUMIZER_VERSION_PATCH < 100,
                  "two digits each");
    EXPECT_EQ(OSGVOLUMIZER_VERSION_NUMBER / 10000, OSGVOLUMIZER_VERSION_MAJOR);
    EXPECT_EQ(OSGVOLUMIZER_VERSION_NUMBER / 100 % 100, OSGVOLUMIZER_VERSION_MINOR);
    EXPECT_EQ(OSGVOLUMIZER_VERSION_NUMBER % 100, OSGVOLUMIZER_VERSION_PATCH);
}

} // namespace VersionTest
