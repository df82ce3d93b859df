// The table of states in the documentation is what the tests assert.
// OSGVOLUMIZER_WRITE_TABLES=1 osgVolumizerStateTests --gtest_filter='StateTable.*' writes it.

#include "StateRow.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace TableTest {

using namespace osgVolumizer::test;

namespace {

const char* const file = OSGVOLUMIZER_SOURCE_DIR "/osgVolumizer/STATE.md";
const std::string begin = "<!-- states: made by tests/state -->\n", end = "<!-- end -->\n";

const char* wordsOf(Effect effect)
{
    switch (effect) {
    case Effect::AS_ON_GEOMETRY:
        return "as on geometry";
    case Effect::NONE:
        return "no effect";
    case Effect::NONE_YET:
        break;
    }
    return "no effect yet";
}

std::string table()
{
    std::string text = "| state | above a volume | what it means, or why not |\n|---|---|---|\n";
    for (const StateRow& row : stateRows())
        text += "| " + row.state + " | " + wordsOf(row.effect) + " | " + row.why + " |\n";
    return text;
}

TEST(StateTable, IsInTheDocumentation)
{
    std::ifstream in(file);
    std::stringstream read;
    read << in.rdbuf();
    std::string text = read.str();
    const std::size_t first = text.find(begin), last = text.find(end, first);
    ASSERT_NE(last, std::string::npos) << file;
    const std::size_t start = first + begin.size();
    if (std::getenv("OSGVOLUMIZER_WRITE_TABLES")) {
        text.replace(start, last - start, table());
        std::ofstream(file) << text;
        return;
    }
    EXPECT_EQ(text.substr(start, last - start), table())
        << "OSGVOLUMIZER_WRITE_TABLES=1 writes it anew.";
}

} // namespace

} // namespace TableTest
