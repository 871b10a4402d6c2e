#include <array>

#include <gtest/gtest.h>

#include <tether/base/suggest.h>

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

TEST(QuotedList, ReadsAsASentence) {
  EXPECT_EQ(quoted_list({}), "none");
  EXPECT_EQ(quoted_list({kKeys.data(), 1}), "'rate_hz'");
  EXPECT_EQ(quoted_list({kKeys.data(), 3}), "'rate_hz', 'period_ms' and 'phase_ms'");
}

}  // namespace
}  // namespace tether
