#include "json_text.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace tether::link {
namespace {

TEST(JsonText, AcceptsObjects) {
  for (const std::string text :
       {"{}", " \t\r\n{ }\n", R"({"a": 1, "b": -0.5e-1, "c": [true, false, null], "d": {"e": []}})",
        R"({"a":"\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00", "":""})",
        "{\"\u00e9\u20ac\U0001F600\": [[1, 2], [\"x\", {}]]}", R"({"a":0,"a":10,"a":1.0})"}) {
    EXPECT_FALSE(fault_of_json_object(text)) << text;
  }
}

// The grammar is the library's; here are the places of faults, and what the library would accept.
TEST(JsonText, FindsWhereAnythingElseFails) {
  const std::vector<std::pair<std::string, std::size_t>> cases = {
      {"", 0},
      {"[1]", 0},
      {" \t[1]", 2},
      {"\n", 1},
      {"\xef\xbb\xbf{}", 0},
      {"{", 1},
      {"{}{}", 2},
      {"{\"a\":NaN}", 5},
      {"{\"a\":[1,]}", 8},
      {"{\"a\":01}", 6},
      {"{\"a\":1e400}", 9},
      {"{\"a\":\"\\ud800\"}", 12},
      {"{'a':1}", 1},
      {"{\"a\":\"\xed\xa0\x80\"}", 7},
      {"{\"a\":\"\n\"}", 6},
      {std::string("{\"a\":1}\0", 8), 7},
      {std::string("{\0}", 3), 1}};
  for (const auto& [text, fault] : cases) EXPECT_EQ(fault_of_json_object(text), fault) << text;
}

}  // namespace
}  // namespace tether::link
