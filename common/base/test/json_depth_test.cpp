#include <string>

#include <gtest/gtest.h>

#include <tether/base/text.h>

namespace tether {
namespace {

TEST(JsonDepth, CountsObjectsAndListsWithinEachOther) {
  EXPECT_EQ(json_depth("1"), 0);
  EXPECT_EQ(json_depth("{}"), 1);
  EXPECT_EQ(json_depth(R"({"a": [[1], [2]], "b": {}})"), 3);
  EXPECT_EQ(json_depth(std::string(100'000, '[')), 100'000);
}

TEST(JsonDepth, IgnoresBracketsInStrings) {
  EXPECT_EQ(json_depth(R"({"[[[": "{{{"})"), 1);
  EXPECT_EQ(json_depth(R"({"\"[": "\\", "b": []})"), 2);
}

}  // namespace
}  // namespace tether
