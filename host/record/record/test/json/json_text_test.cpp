#include "json/json_text.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/base/random.h>

namespace tether::record {
namespace {

std::string json_string(std::string_view text) {
  std::string out;
  append_json_string(out, text);
  return out;
}

std::string number(double value) {
  std::string out;
  append_json_number(out, value);
  return out;
}

TEST(JsonText, EscapesWhatJsonMustEscape) {
  EXPECT_EQ(json_string("plain"), "\"plain\"");
  EXPECT_EQ(json_string("a\"b\\c\nd\x01"), "\"a\\\"b\\\\c\\nd\\u0001\"");
  EXPECT_EQ(json_string(std::string_view("\0", 1)), "\"\\u0000\"");
}

TEST(JsonText, EveryByteStringBecomesValidJson) {
  KeyedRandom random({.seed = 3});
  for (int round = 0; round < 20'000; ++round) {
    std::string bytes;
    for (unsigned i = random.bits() % 12; i > 0; --i) {
      // Mostly lead and continuation bytes, so that sequences come about.
      bytes += static_cast<char>(random.bits() % 4 == 0 ? random.bits() % 256
                                                        : 0x80 + random.bits() % 128);
    }
    const auto parsed = nlohmann::json::parse(json_string(bytes), nullptr, false);
    ASSERT_TRUE(parsed.is_string()) << round;
    EXPECT_EQ(parsed.get<std::string>(), to_utf8(bytes));
  }
}

TEST(JsonText, KeepsUtf8AndReplacesOtherBytes) {
  for (const char* valid : {"é", "€", "😀", "\xF4\x8F\xBF\xBF", "\xED\x9F\xBF"}) {
    EXPECT_EQ(to_utf8(valid), valid);
  }
  EXPECT_EQ(to_utf8("a\xFF"
                    "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(to_utf8("\xC0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(to_utf8("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(JsonText, NumbersReadBackExactly) {
  KeyedRandom random({.seed = 4});
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = static_cast<std::uint64_t>(random.bits()) << 32 | random.bits();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    const auto parsed = nlohmann::json::parse(number(value));
    if (std::isfinite(value)) {
      ASSERT_EQ(parsed.get<double>(), value);
    } else {
      ASSERT_TRUE(parsed.is_null());
    }
  }
}

TEST(JsonText, NumbersAreShort) {
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(1.0), "1");
  EXPECT_EQ(number(0.0), "0");
  EXPECT_EQ(number(-0.0), "-0.0");
  EXPECT_TRUE(std::signbit(nlohmann::json::parse(number(-0.0)).get<double>()));
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "null");
}

TEST(JsonText, Base64RoundTripsEveryLength) {
  KeyedRandom random({.seed = 5});
  std::vector<std::uint8_t> bytes;
  for (int length = 0; length < 70; ++length) {
    std::string text;
    append_base64(text, bytes);
    std::vector<std::uint8_t> decoded;
    ASSERT_TRUE(decode_base64(text, decoded));
    EXPECT_EQ(decoded, bytes);
    bytes.push_back(static_cast<std::uint8_t>(random.bits()));
  }
}

TEST(JsonText, RejectsWhatIsNotBase64) {
  std::vector<std::uint8_t> out;
  for (const char* text : {"a", "ab", "abc", "a b=", "ab=c", "====", "=abc"})
    EXPECT_FALSE(decode_base64(text, out)) << text;
  ASSERT_TRUE(decode_base64("Zm9vYg==", out));  // RFC 4648, section 10
  EXPECT_EQ(std::string(out.begin(), out.end()), "foob");
}

}  // namespace
}  // namespace tether::record
