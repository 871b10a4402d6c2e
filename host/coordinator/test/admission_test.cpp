#include "admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using link::Refusal;
using testing::HasSubstr;

link::Hello hello(const std::string& uav) {
  link::Hello h;
  h.uav = uav;
  h.token = "secret";
  return h;
}

std::variant<std::size_t, Refusal> admit_to_two(const link::Hello& h,
                                                std::vector<bool> taken = {false, false}) {
  return admit(h, "secret", {"alpha", "beta"}, taken);
}

TEST(Admission, GivesTheUavAskedFor) {
  EXPECT_EQ(std::get<std::size_t>(admit_to_two(hello("beta"))), 1u);
}

TEST(Admission, TheOnlyUavNeedsNoName) {
  EXPECT_EQ(std::get<std::size_t>(admit(hello(""), "secret", {"alpha"}, {false})), 0u);
}

struct RefusalCase {
  link::Hello hello;
  std::vector<bool> taken;
  Refusal::Reason reason;
  const char* text;
};

TEST(Admission, RefusesWithAReason) {
  link::Hello old = hello("alpha");
  old.protocol_version = link::kProtocolVersion + 1;
  old.token = "wrong too";
  link::Hello stranger = hello("nobody");
  stranger.token = "Secret";
  link::Hello without = hello("alpha");
  without.token.clear();
  const RefusalCase cases[] = {
      {old, {false, false}, Refusal::Reason::kVersion, "same version"},
      {stranger, {false, false}, Refusal::Reason::kToken, "TETHER_TOKEN"},
      {without, {false, false}, Refusal::Reason::kToken, "TETHER_TOKEN"},
      {hello("gamma"), {false, false}, Refusal::Reason::kUav, "alpha, beta"},
      {hello(""), {false, false}, Refusal::Reason::kUav, "TETHER_UAV"},
      {hello("beta"), {false, true}, Refusal::Reason::kUav, "already flown"},
  };
  for (const auto& c : cases) {
    const auto result = admit_to_two(c.hello, c.taken);
    ASSERT_TRUE(std::holds_alternative<Refusal>(result)) << c.text;
    EXPECT_EQ(std::get<Refusal>(result).reason, c.reason) << c.text;
    EXPECT_THAT(std::get<Refusal>(result).message, HasSubstr(c.text));
  }
}

TEST(Admission, AConcurrentSutNeedsOneTimeLine) {
  for (const auto clock : {link::ClockKind::kCpu, link::ClockKind::kUnstamped}) {
    link::Hello threads = hello("alpha");
    threads.clock = clock;
    EXPECT_FALSE(clock_fault(threads, std::nullopt));
    threads.concurrent = true;
    EXPECT_THAT(clock_fault(threads, std::nullopt).value_or(""), HasSubstr("no time line"));
  }
}

TEST(Admission, AScaledWallClockIsAnotherOne) {
  link::Hello sut = hello("alpha");
  sut.clock = link::ClockKind::kWall;
  sut.cpu_factor = 4.0;
  const ClockSetting scaled{.kind = link::ClockKind::kWall, .cpu_factor = 4.0};
  EXPECT_FALSE(clock_fault(sut, scaled));
  EXPECT_THAT(clock_fault(sut, ClockSetting{}).value_or(""), HasSubstr("TETHER_CLOCK='wall'"));
  sut.cpu_factor = 1.0;
  EXPECT_THAT(clock_fault(sut, scaled).value_or(""), HasSubstr("TETHER_CLOCK='wall*4'"));
}

TEST(Admission, AStrangerLearnsNothingOfTheRun) {
  link::Hello stranger = hello("gamma");
  stranger.token = "guess";
  EXPECT_THAT(std::get<Refusal>(admit_to_two(stranger)).message, testing::Not(HasSubstr("alpha")));
}

}  // namespace
}  // namespace tether::coordinator
