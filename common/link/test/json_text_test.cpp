#include "json_text.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/link/codec.h>

namespace tether::link {
namespace {

bool is_json_object(std::string_view text) {
  return !fault_of_json_object(text);
}

const std::vector<std::string> kObjects = {
    "{}",
    " \t\r\n{ }\n",
    R"({"a": 1, "b": -0.5e-1, "c": [true, false, null], "d": {"e": []}})",
    R"({"a":"\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00", "":""})",
    "{\"\u00e9\u20ac\U0001F600\": [[1, 2], [\"x\", {}]]}",
    R"({"a":0,"a":10,"a":1.0})",
};

TEST(JsonText, TakesObjects) {
  for (const std::string& text : kObjects) EXPECT_TRUE(is_json_object(text)) << text;
}

TEST(JsonText, SaysWhereAnythingElseFails) {
  struct Case {
    std::string text;
    std::size_t fault;
  };
  const Case cases[] = {
      {"", 0},
      {"[1]", 0},
      {"1", 0},
      {"{", 1},
      {"{]}", 1},
      {"{}{}", 2},
      {"{\"", 2},
      {"{\"a\"}", 4},
      {"{\"a\":}", 5},
      {"{\"a\":nan}", 5},
      {"{\"a\":NaN}", 5},
      {"{\"a\":Infinity}", 5},
      {"{\"a\":1,}", 7},
      {"{\"a\":[1,]}", 8},
      {"{\"a\":[1}}", 7},
      {"{\"a\":01}", 6},
      {"{\"a\":1.}", 7},
      {"{\"a\":\"\\x\"}", 8},
      {"{\"a\":\"\\ud800\"}", 12},
      {"{'a':1}", 1},
      {"{a:1}", 1},
      {"{\"a\":\"\xff\"}", 6},
      {"{\"a\":\"\xed\xa0\x80\"}", 6},
      {"{\"a\":\"\xc3\"}", 6},
      {"{\"a\":\"\n\"}", 7},
      {std::string("{\"a\":1}\0", 8), 7},
  };
  for (const auto& [text, fault] : cases) EXPECT_EQ(fault_of_json_object(text), fault) << text;
}

std::string nested(int levels) {
  const auto inner = static_cast<std::size_t>(levels - 1);
  return "{\"a\":" + std::string(inner, '[') + std::string(inner, ']') + "}";
}

TEST(JsonText, HasALimitedDepth) {
  EXPECT_TRUE(is_json_object(nested(kMaxJsonDepth)));
  EXPECT_FALSE(is_json_object(nested(kMaxJsonDepth + 1)));
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"\":";
  EXPECT_FALSE(is_json_object(objects));
  EXPECT_FALSE(is_json_object("{\"a\":" + std::string(kMaxJsonBytes, '[')));
}

// Another reader takes the same texts. It refuses numbers beyond double's range, which these are
// not.
TEST(JsonText, AgreesWithAnotherReader) {
  std::mt19937 random(7);
  const std::string some = "{}[]\",:\\u-.e1 tn\n\xc3\xa9\xed\xff";
  const auto draw = [&](std::size_t below) { return random() % below; };
  int accepted = 0;
  for (int i = 0; i < 50'000; ++i) {
    std::string text = kObjects[draw(kObjects.size())];
    for (std::size_t changes = 1 + draw(2); changes > 0 && !text.empty(); --changes) {
      const std::size_t at = draw(text.size());
      const bool is_inserted = draw(2) == 0;
      text.replace(at, is_inserted ? 0 : 1, draw(3) == 0 ? "" : some.substr(draw(some.size()), 1));
    }
    const auto other = nlohmann::json::parse(text, nullptr, false);
    EXPECT_EQ(is_json_object(text), other.is_object()) << text;
    accepted += other.is_object() ? 1 : 0;
  }
  EXPECT_GT(accepted, 2'000);
  EXPECT_LT(accepted, 48'000);
}

}  // namespace
}  // namespace tether::link
