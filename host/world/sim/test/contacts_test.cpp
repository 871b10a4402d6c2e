#include <gtest/gtest.h>

#include <tether/sim/contacts.h>

namespace tether::sim {
namespace {

SimTime touched_ms(std::int64_t ms) {
  return from_ns<SimTime>(ms * 1'000'000);
}

struct TouchCase {
  std::string name;
  std::vector<Touch> touches;
  std::vector<Contact> contacts;
};

class ContactLogTest : public ::testing::TestWithParam<TouchCase> {};

TEST_P(ContactLogTest, MakesContactsOfTouches) {
  ContactLog log;
  std::vector<Contact> contacts;
  for (const Touch& touch : GetParam().touches) log.add(touch);
  EXPECT_EQ(log.take(), GetParam().contacts);
  EXPECT_EQ(log.take(), std::vector<Contact>{}) << "each is taken once";
}

const std::vector<TouchCase> kTouchCases = {
    {"Lasting",
     {{touched_ms(1), 0, "a", 1, 4.0}, {touched_ms(2), 0, "a", 1, 0.1}},
     {{touched_ms(1), 0, "a", 4.0}}},
    {"Bouncing",
     {{touched_ms(1), 0, "a", 1, 1.0},
      {touched_ms(101), 0, "a", 1, 0.3},
      {touched_ms(201), 0, "a", 1, 0.4}},
     {{touched_ms(1), 0, "a", 1.0}}},
    {"AgainLater",
     {{touched_ms(1), 0, "a", 1, 1.0}, {touched_ms(102), 0, "a", 1, 0.3}},
     {{touched_ms(1), 0, "a", 1.0}, {touched_ms(102), 0, "a", 0.3}}},
    {"SeveralPointsAndShapesAtOnce",
     {{touched_ms(1), 0, "a", 1, 1.0},
      {touched_ms(1), 0, "a", 1, 2.0},
      {touched_ms(1), 0, "a", 2, 1.5}},
     {{touched_ms(1), 0, "a", 2.0}}},
    {"OnTheFloorIntoTheWallOfOneModel",
     {{touched_ms(1), 0, "a", 1, 0.0},
      {touched_ms(2), 0, "a", 1, 0.0},
      {touched_ms(2), 0, "a", 2, 4.0},
      {touched_ms(3), 0, "a", 1, 0.0},
      {touched_ms(3), 0, "a", 3, 0.5}},
     {{touched_ms(1), 0, "a", 0.0}, {touched_ms(2), 0, "a", 4.0}}},
    {"EachPairAlone",
     {{touched_ms(1), 0, "b", 1, 1.0},
      {touched_ms(1), 1, "a", 1, 1.0},
      {touched_ms(2), 0, "c", 1, 0.5}},
     {{touched_ms(1), 0, "b", 1.0}, {touched_ms(1), 1, "a", 1.0}, {touched_ms(2), 0, "c", 0.5}}},
    {"DepartingHasNoSpeed", {{touched_ms(1), 0, "a", 1, -1.0}}, {{touched_ms(1), 0, "a", 0.0}}},
};

INSTANTIATE_TEST_SUITE_P(Touches, ContactLogTest, ::testing::ValuesIn(kTouchCases),
                         [](const auto& named) { return named.param.name; });

}  // namespace
}  // namespace tether::sim
