#include <osgVolumizer/core/Text.h>

#include <gtest/gtest.h>

#include <cmath>

namespace TextTest {

using namespace osgVolumizer::core;

TEST(Text, NumbersAreWholeWords)
{
    double value = 7.0;
    for (const char* bad : {"", " ", "1 ", "1x", "--1", "+-1", "+", "1e999", "0x10", "1,5"}) {
        EXPECT_FALSE(parseNumber(bad, value)) << bad;
        EXPECT_EQ(7.0, value);
    }
    EXPECT_TRUE(parseNumber("+1.5e-3", value));
    EXPECT_EQ(1.5e-3, value);
    EXPECT_TRUE(parseNumber("-inf", value));
    EXPECT_TRUE(std::isinf(value));
    std::int64_t integer = 0;
    EXPECT_TRUE(parseInteger("-9223372036854775808", integer));
    EXPECT_FALSE(parseInteger("9223372036854775808", integer));
    EXPECT_FALSE(parseInteger("1.0", integer));
}

TEST(Text, ListsHaveTheirLength)
{
    double values[3] = {};
    EXPECT_TRUE(parseNumbers("1,2.5,-3", values, 3));
    EXPECT_EQ(2.5, values[1]);
    for (const char* bad : {"1,2", "1,2,3,4", "1,,3", "1,2,", "1, 2,3"})
        EXPECT_FALSE(parseNumbers(bad, values, 3)) << bad;
}

TEST(Text, Splits)
{
    EXPECT_EQ((std::vector<std::string_view>{"a", "", "b", ""}), splitText("a,,b,", ','));
    EXPECT_EQ((std::vector<std::string_view>{""}), splitText("", ','));
    EXPECT_EQ((std::vector<std::string_view>{"a", "b"}), splitBlanks(" a \t\r\n b "));
    EXPECT_TRUE(splitBlanks(" \n").empty());
}

TEST(Text, OptionsMayBeQuoted)
{
    const auto text = [](const std::string& options) {
        std::string result;
        for (const Option& o : splitOptions(options))
            result += "[" + o.name + (o.hasValue ? "=" : "") + o.value + (o.closed ? "]" : "|");
        return result;
    };
    EXPECT_EQ("[a=1][b=][c]", text(" a=1  b= c\t"));
    EXPECT_EQ("[table=my table.lut][x=2]", text("table=\"my table.lut\" x=2"));
    EXPECT_EQ("[table=it's][y=a\"b]", text("table=\"it's\" y='a\"b'"));
    EXPECT_EQ("[table=my table.lut][z]", text("'table=my table.lut' z"));
    EXPECT_EQ("[t=no end x=1|", text("t=\"no end x=1"));
    EXPECT_EQ("[o=O'Brien]", text("o=O'Brien")); // within a word it is a letter like any other
    EXPECT_EQ("[=v][a==b]", text("=v a==b"));
    EXPECT_EQ("", text(" \n"));
    EXPECT_EQ("[|", text("\""));
}

TEST(Text, FormattedNumbersReadBack)
{
    for (const double v : {0.1, 1.0 / 3.0, -5e-324, 1.7976931348623157e308, 1e21}) {
        double back = 0.0;
        ASSERT_TRUE(parseNumber(formatNumber(v), back));
        EXPECT_EQ(v, back);
    }
    EXPECT_EQ("0.1", formatNumber(0.1));
}

} // namespace TextTest
