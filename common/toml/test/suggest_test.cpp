#include <array>

#include <gtest/gtest.h>

#include <tether/toml/suggest.h>

namespace tether::toml {
namespace {

constexpr std::array<std::string_view, 4> kKeys = {"rate_hz", "period_ms", "phase_ms", "delay"};

TEST(Nearest, FindsSlipsOfTheKeyboard) {
  EXPECT_EQ(nearest("dealy", kKeys), "delay");
  EXPECT_EQ(nearest("delai", kKeys), "delay");
  EXPECT_EQ(nearest("perod_ms", kKeys), "period_ms");
}

TEST(Nearest, FindsAnotherUnit) {
  EXPECT_EQ(nearest("period_s", kKeys), "period_ms");
  EXPECT_EQ(nearest("rate", kKeys), "rate_hz");
}

TEST(Nearest, FindsNothingForAnotherWord) {
  EXPECT_EQ(nearest("colour", kKeys), "");
  EXPECT_EQ(nearest("x", kKeys), "");
  EXPECT_EQ(nearest(std::string(100'000, 'd'), kKeys), "");
  EXPECT_EQ(nearest("delay", {}), "");
}

TEST(QuotedList, ReadsAsASentence) {
  EXPECT_EQ(quoted_list({}), "none");
  EXPECT_EQ(quoted_list({kKeys.data(), 1}), "'rate_hz'");
  EXPECT_EQ(quoted_list({kKeys.data(), 3}), "'rate_hz', 'period_ms' and 'phase_ms'");
}

}  // namespace
}  // namespace tether::toml
