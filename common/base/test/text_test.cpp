#include <gtest/gtest.h>

#include <tether/base/text.h>

namespace tether {
namespace {

TEST(Text, KeepsTextAndReplacesControlCharacters) {
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

TEST(Counted, IsSingularForOne) {
  EXPECT_EQ(counted(0, "flight"), "0 flights");
  EXPECT_EQ(counted(1, "flight"), "1 flight");
  EXPECT_EQ(counted(2, "flight"), "2 flights");
}

TEST(Text, IsTheSameWithoutCaseAndEscapes) {
  EXPECT_EQ(lower_case("Az\xC3\x9C.PNG"), "az\xC3\x9C.png");
  const std::pair<std::string, std::string> cases[] = {
      {"Ground%20Plane", "Ground Plane"}, {"%41%zz%4", "A%zz%4"}, {"%%41", "%A"}, {"", ""}};
  for (const auto& [uri, text] : cases) EXPECT_EQ(unescaped(uri), text);
}

}  // namespace
}  // namespace tether
