#include <gtest/gtest.h>

#include <tether/base/printable.h>

namespace tether {
namespace {

TEST(Printable, KeepsTextAndReplacesControlCharacters) {
  const std::pair<std::string, std::string> cases[] = {
      {"Gazebo 11.1.0, ODE", "Gazebo 11.1.0, ODE"},
      {"Z\xC3\xBCrich \xC2\xA0 \xE2\x82\xAC", "Z\xC3\xBCrich \xC2\xA0 \xE2\x82\xAC"},
      {"a\x1b[31mb\nc\rd\x7f", "a?[31mb?c?d?"},
      {"a\xC2\x9B"
       "31m",
       "a?31m"},
      {std::string("a\0b", 3), "a?b"},
      {"  a b ", "a b"},
      {"   ", ""},
      {"", ""}};
  for (const auto& [text, expected] : cases) EXPECT_EQ(printable(text), expected);
}

}  // namespace
}  // namespace tether
