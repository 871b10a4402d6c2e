#include <array>

#include <gtest/gtest.h>

#include <tether/base/text.h>

namespace tether {
namespace {

constexpr std::array<std::string_view, 4> kKeys = {"rate_hz", "period_ms", "phase_ms", "delay"};

TEST(Nearest, FindsTyposAndOtherUnits) {
  for (const auto& [word, key] : {std::pair{"dealy", "delay"},
                                  {"delai", "delay"},
                                  {"perod_ms", "period_ms"},
                                  {"period_s", "period_ms"},
                                  {"DELAY", "delay"},
                                  {"rate", "rate_hz"}}) {
    EXPECT_EQ(nearest(word, kKeys), key);
  }
}

TEST(Nearest, FindsNothingForAnotherWord) {
  for (const std::string& word :
       {std::string("colour"), std::string("x"), std::string(100'000, 'd')})
    EXPECT_EQ(nearest(word, kKeys), "");
  EXPECT_EQ(nearest("delay", {}), "");
}

TEST(Misspelt, IsAWordWithOneMistakeAndTheSameUnit) {
  EXPECT_TRUE(is_misspelt("clauses", "clause"));
  EXPECT_TRUE(is_misspelt("withn_s", "within_s"));
  EXPECT_TRUE(is_misspelt("on_mis", "on_miss"));
  EXPECT_FALSE(is_misspelt("clause", "clause"));
  EXPECT_FALSE(is_misspelt("within_m", "within_s"));
  EXPECT_FALSE(is_misspelt("radius_m", "retry"));
}

TEST(QuotedList, ReadsAsASentence) {
  EXPECT_EQ(quoted_list({}), "none");
  EXPECT_EQ(quoted_list({kKeys.data(), 1}), "'rate_hz'");
  EXPECT_EQ(quoted_list({kKeys.data(), 3}), "'rate_hz', 'period_ms' and 'phase_ms'");
}

}  // namespace
}  // namespace tether
