#include <gmock/gmock.h>

#include <tether/mission/mission.h>

namespace tether::mission {
namespace {

using ::testing::HasSubstr;

TEST(Condition, IsReadAsItIsWritten) {
  for (const char* text : {"clearance >= 0.3 m", "bearing_error of blue_box <= 5 deg",
                           "yaw_rate <= -1.5e-07 rad/s", "reaction_time <= 150 ms in 95 %"}) {
    const auto condition = parse_condition(text);
    ASSERT_TRUE(condition) << condition.failure().message;
    EXPECT_EQ(condition->text(), text);
  }
  const auto condition = parse_condition("  reaction_time of eye\t<= 0.15 s in 95%");
  ASSERT_TRUE(condition) << condition.failure().message;
  EXPECT_EQ(condition->quantity->name, "reaction_time");
  EXPECT_EQ(condition->of, "eye");
  EXPECT_TRUE(condition->at_most);
  EXPECT_EQ(condition->bound, 0.15);
  EXPECT_EQ(condition->unit->name, "s");
  EXPECT_DOUBLE_EQ(condition->share, 0.95);
}

TEST(Condition, RefusalNamesWhatIsWrong) {
  struct Case {
    const char* text;
    const char* named;
  };
  for (const Case& c :
       std::vector<Case>{{"", "no quantity \"\""},
                         {"height <= 1 m", "\"height\""},
                         {"clearence <= 1 m", "did you mean 'clearance'"},
                         {"altitude of blue_box <= 1 m", "of blue_box"},
                         {"distance of", "after 'of'"},
                         {"altitude < 1 m", "\"<\""},
                         {"altitude <= high m", "\"high\""},
                         {"altitude <= nan m", "\"nan\""},
                         {"altitude <= 1m", "\"1m\""},
                         {"altitude <= 1", "lacks a unit. Write 1 m or 1 cm"},
                         {"reaction_time <= 200 in 95 %", "lacks a unit. Write 200 s or 200 ms"},
                         {"altitude <= 1 deg", "\"deg\""},
                         {"altitude <= 1 m in 0 %", "share"},
                         {"altitude <= 1 m in 101 %", "share"},
                         {"altitude <= 1 m in 95", "share"},
                         {"altitude <= 1 m always", "\"always\""}}) {
    const auto condition = parse_condition(c.text);
    ASSERT_FALSE(condition) << c.text;
    EXPECT_THAT(condition.failure().message, HasSubstr(c.named)) << c.text;
  }
}

}  // namespace
}  // namespace tether::mission
