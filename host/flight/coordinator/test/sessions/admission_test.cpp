#include "sessions/admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using link::Refusal;
using std::chrono::microseconds;
using testing::HasSubstr;

link::Hello hello_for(const std::string& uav) {
  link::Hello h;
  h.uav = uav;
  h.token = "secret";
  return h;
}

std::variant<std::size_t, Refusal> admit_to_two(const link::Hello& h,
                                                std::vector<bool> taken = {false, false}) {
  return admit(h, "secret", {"alpha", "beta"}, taken);
}

TEST(Admission, GivesTheRequestedOrTheOnlyUav) {
  EXPECT_EQ(std::get<std::size_t>(admit_to_two(hello_for("beta"))), 1u);
  EXPECT_EQ(std::get<std::size_t>(admit(hello_for(""), "secret", {"alpha"}, {false})), 0u);
}

// A client without the token does not learn the names of UAVs.
TEST(Admission, RejectsWithAReason) {
  struct Case {
    std::string uav;
    std::string token = "secret";
    bool beta_is_taken = false;
    Refusal::Reason reason;
    bool names_uavs = false;
  };
  const Case cases[] = {{.uav = "gamma", .token = "Secret", .reason = Refusal::Reason::kToken},
                        {.uav = "alpha", .token = "", .reason = Refusal::Reason::kToken},
                        {.uav = "gamma", .reason = Refusal::Reason::kUav, .names_uavs = true},
                        {.uav = "", .reason = Refusal::Reason::kUav, .names_uavs = true},
                        {.uav = "beta", .beta_is_taken = true, .reason = Refusal::Reason::kUav}};
  for (const Case& c : cases) {
    link::Hello h = hello_for(c.uav);
    h.token = c.token;
    const auto result = admit_to_two(h, {false, c.beta_is_taken});
    ASSERT_TRUE(std::holds_alternative<Refusal>(result)) << c.uav;
    EXPECT_EQ(std::get<Refusal>(result).reason, c.reason) << c.uav;
    EXPECT_EQ(std::get<Refusal>(result).message.find("alpha") != std::string::npos, c.names_uavs);
    h.protocol_version = link::kProtocolVersion + 1;
    EXPECT_EQ(std::get<Refusal>(admit_to_two(h)).reason, Refusal::Reason::kVersion);
  }
}

TEST(Admission, AConcurrentSutNeedsAClockForAllThreads) {
  for (const auto clock : {computer::ClockKind::kCpu, computer::ClockKind::kUnstamped}) {
    link::Hello threads = hello_for("alpha");
    threads.clock.kind = clock;
    EXPECT_FALSE(clock_fault(threads, std::nullopt));
    threads.concurrent = true;
    EXPECT_TRUE(clock_fault(threads, std::nullopt));
  }
}

TEST(Admission, OnlyTheClockOfTheConditionIsAccepted) {
  const std::pair<computer::Clock, std::string> clocks[] = {
      {{.kind = computer::ClockKind::kWall}, "'wall'"},
      {{.kind = computer::ClockKind::kWall, .factor = 4.0}, "'wall*4'"},
      {{.kind = computer::ClockKind::kCpu}, "'cpu'"},
      {{.kind = computer::ClockKind::kCpu, .factor = 12.0}, "'cpu*12'"},
      {{.kind = computer::ClockKind::kScripted, .computing = microseconds(1)}, "'scripted*0.001'"},
      {{.kind = computer::ClockKind::kScripted, .computing = microseconds(2500)}, "'scripted*2.5'"},
      {{.kind = computer::ClockKind::kUnstamped}, ""}};
  for (const auto& [wanted, advice] : clocks) {
    for (const auto& [own, unused] : clocks) {
      link::Hello sut = hello_for("alpha");
      sut.clock = own;
      const auto fault = clock_fault(sut, wanted);
      EXPECT_EQ(fault.has_value(), own != wanted);
      EXPECT_FALSE(clock_fault(sut, std::nullopt));
      const bool is_stamped = own.kind != computer::ClockKind::kUnstamped;
      EXPECT_THAT(is_stamped ? fault.value_or(advice) : advice, HasSubstr(advice));
    }
  }
}

}  // namespace
}  // namespace tether::coordinator
