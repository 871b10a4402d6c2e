#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Whoever may not join is told why, and the run of the others goes on as if nothing had been.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AnyOf;
using testing::HasSubstr;

class Intruders : public testing::Test {
 protected:
  /// A run of the good SUT under a scripted clock, slow enough to be disturbed; `disturb` is called
  /// before it starts and again when it flies.
  template <class Disturb>
  void fly(const std::string& out, const std::vector<std::string>& options, Disturb disturb) {
    ExternalRun run(scenario_, folder_ / out, options);
    disturb(run, false);
    const auto sut = run.start_sut({bad_sut_program(), "good"});
    ASSERT_TRUE(sut->wait_for_out("joined", 20s)) << sut->err();
    disturb(run, true);
    EXPECT_EQ(run.wait().code, 0);
    EXPECT_EQ(sut->wait(5s).code, 0);
  }
  void fly_alone(const std::string& out) {
    fly(out, {}, [](const ExternalRun&, bool) {});
  }
  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_EQ(timeless_result(folder_ / a), timeless_result(folder_ / b));
    EXPECT_EQ(timeless_record(folder_ / a), timeless_record(folder_ / b));
  }

  TempFolder folder_;
  std::filesystem::path scenario_ = write_hover_scenario(folder_.path(), "good");
};

TEST_F(Intruders, AreRefusedAndChangeNothing) {
  fly_alone("alone");
  fly("disturbed", {"--real-time-factor", "0.5"}, [](const ExternalRun& run, bool flying) {
    const Output token =
        run.start_sut({bad_sut_program(), "good"}, {{"TETHER_TOKEN", "guessed"}})->wait(20s);
    EXPECT_EQ(token.code, 3);
    EXPECT_THAT(token.err, HasSubstr("token"));

    const Output none =
        run.start_sut({bad_sut_program(), "good"}, {{"TETHER_TOKEN", ""}})->wait(20s);
    EXPECT_THAT(none.code, AnyOf(2, 3));
    EXPECT_THAT(none.err, AnyOf(HasSubstr("TETHER_TOKEN"), HasSubstr("token")));

    const Output uav =
        run.start_sut({bad_sut_program(), "good"}, {{"TETHER_UAV", "uav9"}})->wait(20s);
    EXPECT_EQ(uav.code, 3);
    EXPECT_THAT(uav.err, HasSubstr("uav9"));
    EXPECT_THAT(uav.err, HasSubstr("uav1"));

    const Output clock =
        run.start_sut({bad_sut_program(), "good"}, {{"TETHER_CLOCK", "cpu*7"}})->wait(20s);
    EXPECT_EQ(clock.code, 3);

    const Output garbage = run.start_sut({bad_sut_program(), "garbage"})->wait(20s);
    EXPECT_EQ(garbage.code, 0);

    if (!flying) return;
    const Output second = run.start_sut({bad_sut_program(), "good"})->wait(20s);
    EXPECT_EQ(second.code, 3);
    EXPECT_THAT(second.err, HasSubstr("uav1"));
  });
  expect_same("alone", "disturbed");
}

TEST(Token, IsNewForEachRun) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good");
  const std::string key = "TETHER_TOKEN=";
  std::vector<std::string> tokens;
  for (const char* out : {"a", "b"}) {
    Command command = tether({"run", scenario, "--target", "wait", "--out", folder / out});
    command.environment.emplace_back("TETHER_TOKEN", "");
    Process process(command);
    ASSERT_TRUE(process.wait_for_err(key, 30s)) << process.err();
    ASSERT_TRUE(process.wait_for_err("bad_sut good", 5s)) << process.err();
    const std::string text = process.err();
    const auto begin = text.find(key) + key.size();
    tokens.push_back(text.substr(begin, text.find(' ', begin) - begin));
  }
  EXPECT_GE(tokens[0].size(), 32u);
  EXPECT_NE(tokens[0], tokens[1]);
}

/// Two runs into one folder would each take the other's record for their own.
TEST_F(Intruders, ASecondRunIntoTheSameFolderIsRefusedAndTheFirstUnharmed) {
  fly_alone("alone");
  fly("shared_folder", {"--real-time-factor", "0.5"}, [this](const ExternalRun&, bool) {
    const Output second = run(tether({"run", scenario_, "--out", folder_ / "shared_folder"}));
    EXPECT_EQ(second.code, 2);
    EXPECT_THAT(second.err, HasSubstr((folder_ / "shared_folder").string()));
  });
  expect_same("alone", "shared_folder");
}

}  // namespace
}  // namespace tether::system_test
