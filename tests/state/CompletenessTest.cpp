// No state that OSG has is missing from the table.

#include "StateRow.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace CompletenessTest {

using namespace osgVolumizer::test;

namespace {

std::string textOf(const std::filesystem::path& file)
{
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

const std::filesystem::path headers = std::filesystem::path(OSGVOLUMIZER_OSG_INCLUDE_DIR) / "osg";

/// Classes of OSG's headers that derive from StateAttribute.
std::set<std::string> attributeClasses()
{
    const std::regex derived(
        "class\\s+(?:OSG_EXPORT\\s+)?(\\w+)\\s*:\\s*public\\s+(?:osg::)?(\\w+)");
    std::multimap<std::string, std::string> derivedFrom;
    for (const auto& file : std::filesystem::directory_iterator(headers)) {
        if (!file.is_regular_file()) continue;
        const std::string text = textOf(file.path());
        for (std::sregex_iterator m(text.begin(), text.end(), derived), end; m != end; ++m)
            derivedFrom.emplace((*m)[2], (*m)[1]);
    }
    std::set<std::string> found;
    std::vector<std::string> bases = {"StateAttribute"};
    while (!bases.empty()) {
        const auto range = derivedFrom.equal_range(bases.back());
        bases.pop_back();
        for (auto c = range.first; c != range.second; ++c)
            if (found.insert(c->second).second) bases.push_back(c->second);
    }
    return found;
}

/// Names and values of StateAttribute::Type.
std::map<std::string, int> attributeTypes()
{
    const std::string text = textOf(headers / "StateAttribute");
    const std::size_t begin = text.find('{', text.find("enum Type")) + 1;
    std::string list = text.substr(begin, text.find('}', begin) - begin);
    list = std::regex_replace(list, std::regex("//[^\n]*"), "");
    const std::regex name("(\\w+)(?:\\s*=\\s*(\\d+))?\\s*(?:,|$)");
    std::map<std::string, int> types;
    int next = 0;
    for (std::sregex_iterator m(list.begin(), list.end(), name), end; m != end; ++m) {
        if ((*m)[2].matched) next = std::stoi((*m)[2]);
        types[(*m)[1]] = next++;
    }
    return types;
}

/// What the rows cover.
struct Covered
{
    std::set<std::string> classes;
    std::set<int> types;

    void add(const osg::StateSet::AttributeList& list)
    {
        for (const auto& entry : list) {
            const osg::StateAttribute& attribute = *entry.second.first;
            classes.insert(attribute.className());
            // A capability's type depends on which it is.
            types.insert(std::min(int(attribute.getType()), int(osg::StateAttribute::CAPABILITY)));
        }
    }
};

Covered covered()
{
    Covered result;
    for (const StateRow& row : stateRows()) {
        const osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
        row.set(*set, osg::StateAttribute::ON);
        result.add(set->getAttributeList());
        for (const auto& unit : set->getTextureAttributeList())
            result.add(unit);
    }
    return result;
}

TEST(StateTable, HasEveryClass)
{
    const std::set<std::string> without = {
        "Texture",          "BufferIndexBinding", "Capability", "Capabilityi", // abstract
        "ClipPlane",        // belongs to a ClipNode; its mode has a row
        "FrameBufferObject" // above a node it takes the camera's framebuffer away for good
    };
    const std::set<std::string> classes = attributeClasses();
    EXPECT_GT(classes.size(), 60u);
    const Covered rows = covered();
    for (const std::string& name : classes)
        EXPECT_TRUE(rows.classes.count(name) || without.count(name)) << name;
    for (const std::string& name : without)
        EXPECT_TRUE(classes.count(name)) << name;
}

TEST(StateTable, HasEveryType)
{
    const std::set<std::string> without = {
        "ANTIALIAS", "COLORTABLE", "INDIRECTDRAWBUFFERBINDING", // no class has them
        "CLIPPLANE", "FRAME_BUFFER_OBJECT",                     // see above
        // Of other libraries, most of them gone.
        "VALIDATOR", "VIEWMATRIXEXTRACTOR", "OSGNV_PARAMETER_BLOCK", "OSGNVEXT_TEXTURE_SHADER",
        "OSGNVEXT_VERTEX_PROGRAM", "OSGNVEXT_REGISTER_COMBINERS", "OSGNVCG_PROGRAM",
        "OSGNVSLANG_PROGRAM", "OSGNVPARSE_PROGRAM_PARSER"};
    const std::map<std::string, int> types = attributeTypes();
    ASSERT_EQ(types.at("CAPABILITY"), int(osg::StateAttribute::CAPABILITY));
    ASSERT_EQ(types.at("SAMPLER"), int(osg::StateAttribute::SAMPLER));
    const Covered rows = covered();
    for (const auto& type : types)
        EXPECT_TRUE(rows.types.count(type.second) || without.count(type.first)) << type.first;
}

TEST(StateTable, HasEachStateOnce)
{
    std::set<std::string> names;
    for (const StateRow& row : stateRows()) {
        EXPECT_TRUE(names.insert(row.state).second) << row.state;
        EXPECT_FALSE(row.why.empty()) << row.state;
    }
}

} // namespace

} // namespace CompletenessTest
