#include <osgVolumizer/core/RecencyCache.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace RecencyCacheTest {

using namespace osgVolumizer::core;

namespace {

using Cache = RecencyCache<int, std::string>;

std::vector<int> keysOf(const Cache& cache)
{
    std::vector<int> keys;
    for (const Cache::Entry& entry : cache)
        keys.push_back(entry.key);
    return keys;
}

Cache abc(std::size_t capacity)
{
    Cache cache(capacity);
    cache.add(1, "a");
    cache.add(2, "b");
    cache.add(3, "c");
    return cache;
}

} // namespace

TEST(RecencyCache, FindsWhatWasAdded)
{
    Cache cache = abc(3);
    ASSERT_TRUE(cache.find(2));
    EXPECT_EQ(*cache.find(2), "b");
    EXPECT_FALSE(cache.find(4));
    *cache.find(2) = "changed";
    EXPECT_EQ(*cache.find(2), "changed");
}

TEST(RecencyCache, ForgetsWhatWasNotAskedForLongest)
{
    Cache cache = abc(3);
    EXPECT_EQ(keysOf(cache), (std::vector<int>{3, 2, 1}));
    ASSERT_TRUE(cache.find(1));
    EXPECT_EQ(keysOf(cache), (std::vector<int>{1, 3, 2}));
    EXPECT_EQ(cache.add(4, "d"), "d");
    EXPECT_EQ(keysOf(cache), (std::vector<int>{4, 1, 3}));
    EXPECT_FALSE(cache.find(2));
    EXPECT_EQ(keysOf(abc(1)), (std::vector<int>{3}));
}

TEST(RecencyCache, AnUnknownKeyChangesNoOrder)
{
    Cache cache = abc(3);
    EXPECT_FALSE(cache.find(7));
    EXPECT_EQ(keysOf(cache), (std::vector<int>{3, 2, 1}));
}

TEST(RecencyCache, ReplacesWithoutForgettingAnother)
{
    Cache cache = abc(3);
    EXPECT_EQ(cache.add(1, "new"), "new");
    EXPECT_EQ(keysOf(cache), (std::vector<int>{1, 3, 2}));
    EXPECT_EQ(*cache.find(1), "new");
}

TEST(RecencyCache, ReferencesStayValid)
{
    Cache cache(3);
    std::string& first = cache.add(1, "a");
    cache.add(2, "b");
    cache.add(3, "c");
    EXPECT_EQ(cache.find(1), &first);
    EXPECT_EQ(first, "a");
}

TEST(RecencyCache, Removes)
{
    Cache cache = abc(3);
    cache.removeIf([](const Cache::Entry& entry) { return entry.key == 2; });
    EXPECT_EQ(keysOf(cache), (std::vector<int>{3, 1}));
    cache.removeIf([](const Cache::Entry& entry) { return entry.value == "c"; });
    EXPECT_EQ(keysOf(cache), (std::vector<int>{1}));
    cache.clear();
    EXPECT_EQ(cache.size(), 0u);
    EXPECT_FALSE(cache.find(1));
}

TEST(RecencyCache, WhatIsForgottenIsFreedBeforeAnotherIsAdded)
{
    RecencyCache<int, std::shared_ptr<int>> cache(1);
    const std::weak_ptr<int> first = cache.add(1, std::make_shared<int>(5));
    EXPECT_FALSE(first.expired());
    cache.add(2, nullptr);
    EXPECT_TRUE(first.expired());
}

} // namespace RecencyCacheTest
