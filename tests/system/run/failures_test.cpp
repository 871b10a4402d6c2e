#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A SUT that fails ends the run in bounded time, with exit code 3, a reason that names it, the
/// record up to there, and no process left.
namespace tether::system_test {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Failing {
  std::string mode;  ///< of bad_sut.cpp
  std::string end;
  std::vector<std::string> reason;  ///< parts of it
  double wall_limit_s;
};

void PrintTo(const Failing& failing, std::ostream* out) {
  *out << failing.mode;
}

std::string mark_of_test() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::string(test->test_suite_name()) + test->name() + std::to_string(getpid());
}

void expect_reason(const Output& output, const nlohmann::json& result,
                   const std::vector<std::string>& parts) {
  const std::string reason = result["reason"];
  EXPECT_THAT(reason, HasSubstr("\"uav1\""));
  for (const std::string& part : parts) EXPECT_THAT(reason, HasSubstr(part));
  EXPECT_THAT(reason, Not(HasSubstr("\n")));
  EXPECT_THAT(output.err, HasSubstr("tether: " + reason));
}

/// Flies the SUT in its mode, and expects what every failure must show; returns the result.
nlohmann::json expect_failure(const TempFolder& folder, const Failing& failing) {
  const std::string mark = mark_of_test();
  const Output output = run(tether(
      {"run", write_hover_scenario(folder.path(), failing.mode), "--out", folder / "out"}, mark));
  EXPECT_EQ(output.code, 3);
  EXPECT_LT(output.wall.count(), failing.wall_limit_s);
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_EQ(result["end"], failing.end);
  expect_reason(output, result, failing.reason);
  EXPECT_TRUE(wait_until_gone(mark));
  return result;
}

// ---- After it has flown for 1.5 s

class FailingInFlight : public testing::TestWithParam<Failing> {};

TEST_P(FailingInFlight, EndsTheRunAndLeavesItsRecord) {
  const TempFolder folder;
  const auto result = expect_failure(folder, GetParam());
  EXPECT_EQ(result["exit_code"], 3);

  const record::Record record = read_record(folder / "out");
  EXPECT_EQ(record.damage, "");
  EXPECT_GE(record.interactions.size(), 400u);
  EXPECT_EQ(record.footer->end, GetParam().end);
  EXPECT_EQ(run(tether({"audit", folder / "out/record.mcap"})).code, 0);
}

const Failing kInFlight[] = {
    {"crash", "sut_lost", {"signal 11"}, 60},
    {"exit", "sut_lost", {}, 60},
    // Its limit is 2 s.
    {"stop", "sut_hung", {"2 s"}, 60},
};

INSTANTIATE_TEST_SUITE_P(Modes, FailingInFlight, testing::ValuesIn(kInFlight),
                         [](const auto& failing) { return failing.param.mode; });

// ---- Before it has joined

class FailingAtStart : public testing::TestWithParam<Failing> {};

TEST_P(FailingAtStart, IsASetUpThatFailed) {
  expect_failure(TempFolder(), GetParam());
}

// Known long before the 30 s that are allowed for joining.
const Failing kAtStart[] = {
    {"exit_at_start", "setup_failed", {"code 7", "cannot open the camera"}, 28},
    {"garbage", "setup_failed", {"bad_sut"}, 28},
    {"garbage_after_hello", "setup_failed", {"bad_sut"}, 28},
    {"never_connect", "setup_failed", {"30 s"}, 90},
};

INSTANTIATE_TEST_SUITE_P(Modes, FailingAtStart, testing::ValuesIn(kAtStart),
                         [](const auto& failing) { return failing.param.mode; });

TEST(FailingAtStart, BecauseThePortIsTaken) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  const ExternalRun other(scenario, folder / "other");
  const Output output =
      run(tether({"run", scenario, "--listen", other.address(), "--out", folder / "out"}));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(other.address()));
}

// ---- Past the time limit

class PastTheTimeLimit : public testing::TestWithParam<std::string> {};

TEST_P(PastTheTimeLimit, MissesItsGoal) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  // CPU time that is stretched tenfold: 5 s of it are soon over.
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), GetParam()),
                                    "--condition", "slow", "--out", folder / "out"},
                                   mark));
  EXPECT_EQ(output.code, 1);
  EXPECT_LT(output.wall.count(), 60);
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["end"], "time_limit");
  EXPECT_EQ(result["outcome"], "goal_missed");
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("5 s"));
  EXPECT_EQ(result["sync"]["st_at_end_s"], 5.0);
  EXPECT_EQ(run(tether({"audit", folder / "out/record.mcap"})).code, 0);
  EXPECT_TRUE(wait_until_gone(mark));
}

INSTANTIATE_TEST_SUITE_P(Modes, PastTheTimeLimit,
                         testing::Values("compute", "sleep_long", "fly_on", "stubborn"));

// ---- Children of a SUT

TEST(SutsChild, DoesNotOutliveTheRun) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const Output output = run(
      tether({"run", write_hover_scenario(folder.path(), "child"), "--out", folder / "out"}, mark));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_TRUE(wait_until_gone(mark));
}

}  // namespace
}  // namespace tether::system_test
