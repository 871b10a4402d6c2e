#include "support/faults.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether campaign` and `tether report`: two conditions, two seeds. What a campaign refuses to
/// resume: host/trial/campaign/test.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// In the order in which they are run.
const std::vector<std::string> kTrials = {"hover/host/seed-0001", "hover/slow/seed-0001",
                                          "hover/host/seed-0002", "hover/slow/seed-0002"};

class Campaign : public RunTest {
 protected:
  Campaign() { write_hover_scenario(folder_.path(), "good"); }

  Command campaign(const std::vector<std::string>& options = {}) const {
    return with(tether({"campaign", campaign_, "--out", out_}, mark_), options);
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const std::string& name : kTrials) texts.push_back(read_text(out_ / name / "result.json"));
    return texts;
  }
  void expect_all(const std::string& end) const {
    for (const std::string& name : kTrials) EXPECT_EQ(read_result(out_ / name)["end"], end) << name;
  }

  const std::filesystem::path campaign_ = write_campaign(folder_.path(), 2);
};

TEST_F(Campaign, RunsEveryTrialReportsAndResumesWithWhatIsMissing) {
  const Output output = run(campaign());
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("host"));
  EXPECT_THAT(output.out, HasSubstr("slow"));
  expect_all("finished");
  for (const std::string& name : kTrials) EXPECT_EQ(audit_code(out_ / name), 0) << name;

  const auto before = texts();
  const Output again = run(campaign());
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("--resume"));
  EXPECT_EQ(texts(), before);

  std::filesystem::remove(out_ / kTrials[1] / "result.json");
  write_text(out_ / kTrials[2] / "result.json", before[2].substr(0, before[2].size() / 2));
  const Output resumed = run(campaign({"--resume", "--jobs", "2"}));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr(kTrials[2]));
  EXPECT_EQ(texts()[0], before[0]);
  EXPECT_EQ(texts()[3], before[3]);
  expect_all("finished");

  write_hover_scenario(folder_.path(), "good", {{"time_limit_s = 5", "time_limit_s = 6"}});
  const Output changed = run(campaign({"--resume"}));
  EXPECT_EQ(changed.code, 2);
  EXPECT_THAT(changed.err, HasSubstr("hover.toml"));
}

// The SUT is a script, given to its shell as an argument, and edits a file.
TEST_F(Campaign, FliesAScenarioWithoutAFileOfItsOwn) {
  const auto fly = [&](const std::vector<std::string>& options) {
    return run(with(
        tether({"campaign", folder_ / "hover.toml", "--trials", "2", "--out", folder_ / "alone"}),
        options));
  };
  EXPECT_EQ(fly({"--condition", "host"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "alone/hover/host/seed-0002/result.json"));
  const Output of_campaign = run(campaign({"--trials", "2"}));
  EXPECT_EQ(of_campaign.code, 2);
  EXPECT_THAT(of_campaign.err, HasSubstr("--trials: is for a scenario"));
  const Output parent = run(tether({"report", folder_.path()}));
  EXPECT_EQ(parent.code, 2);
  EXPECT_THAT(parent.err, HasSubstr("Give one of those in it: " + (folder_ / "alone").string()));
}

TEST_F(Campaign, EndsWhenAFileIsEditedMeanwhile) {
  const std::string scenario = folder_ / "hover.toml", program = bad_sut_program();
  write_text(folder_ / "sut.sh",
             "echo '# edited' >> '" + scenario + "'\nexec '" + program + "' \"$@\"\n");
  write_hover_scenario(
      folder_.path(), "good",
      {{"\"" + program + "\"", "\"/bin/sh\", \"" + (folder_ / "sut.sh").string() + "\""}});
  const Output output = run(campaign());
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr(scenario + ": "));
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  for (const std::string& text : texts()) EXPECT_EQ(text, "");
}

TEST_F(Campaign, GoesOnAfterCtrlC) {
  Process process(campaign());
  ASSERT_TRUE(wait_until([&] { return !texts()[0].empty(); })) << process.err();
  process.signal(SIGINT);
  const Output output = process.wait(15s);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  EXPECT_TRUE(wait_until_gone(mark_));
  const std::string first = texts()[0];
  EXPECT_EQ(texts()[3], "");

  const Output resumed = run(campaign({"--resume"}));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(texts()[0], first);
  expect_all("finished");
}

TEST_F(Campaign, EndsWithThreeWhereTrialsFailAndRunsTheOthers) {
  write_hover_scenario(folder_.path(), "crash");
  EXPECT_EQ(run(campaign()).code, 3);
  expect_all("sut_lost");
  EXPECT_EQ(run(tether({"report", out_})).code, 0);
}

/// scripts/reproduce with a campaign that ends so in place of the paper's.
struct ReproduceCase {
  const char* what;
  const char* campaign;
  const char* report;
  int code;
  bool has_page;
};

TEST(Reproduce, ReportsThePapersCampaignWhateverFailed) {
  const ReproduceCase cases[] = {
      {"all well", "touch $4/campaign.json", "true", 0, true},
      {"a trial failed", "touch $4/campaign.json; exit 3", "true", 3, true},
      {"nothing was run", "exit 2", "true", 2, false},
      {"no page", "touch $4/campaign.json", "exit 5", 5, true},
      {"a trial failed, no page", "touch $4/campaign.json; exit 3", "exit 5", 3, true},
  };
  for (const ReproduceCase& c : cases) {
    const TempFolder root;
    for (const char* folder : {"scripts/lib", "build/release/bin", "out"})
      std::filesystem::create_directories(root / folder);
    std::filesystem::copy(std::string(TETHER_SOURCE_DIR) + "/scripts/reproduce",
                          root / "scripts/reproduce");
    write_text(root / "scripts/lib/common.sh", "set -euo pipefail\nROOT='" + root.path().string() +
                                                   "'\nJOBS=1\ninstall_for() { :; }\n"
                                                   "say() { :; }\nbuild() { :; }\n");
    const auto tether = root / "build/release/bin/tether";
    write_text(tether, "#!/bin/sh\nif [ $1 = report ]; then touch $2/report.html; " +
                           std::string(c.report) + "; else " + c.campaign + "; fi\n");
    std::filesystem::permissions(tether, std::filesystem::perms::owner_all);
    const Output output = run({{"bash", root / "scripts/reproduce", root / "out"}});
    EXPECT_EQ(output.code, c.code) << c.what << output.err;
    EXPECT_EQ(std::filesystem::exists(root / "out/report.html"), c.has_page) << c.what;
  }
}

// Alone, a UAV needs 4.0 s; of two on one core, each needs 5.5 s.
TEST_F(RunTest, SizeFindsHowManyUavsABoardCarries) {
  const std::string limit = "kind = \"time_required\"\nmax_s = 4.5\nuav = ";
  const auto scenario = write_hover_scenario(
      folder_.path(), "good",
      {{"time_limit_s = 5", "time_limit_s = 10"},
       {"[[uav]]\n",
        "[[target]]\nname = \"obc\"\nclock = \"scripted\"\ncomputing_ms = 5\n\n"
        "[[uav]]\ntarget = \"obc\"\n"},
       {"[sut]\n", "[[uav]]\nname = \"uav2\"\ntarget = \"obc\"\nmodel = \"" TETHER_SOURCE_DIR
                   "/data/models/hummingbird/model.sdf\"\nposition_m = [5, 0, 1]\n\n[sut]\n"},
       {"clock = \"cpu\"\n\n", "\n"},
       {"kind = \"time_required\"", limit + "\"uav1\"\n[[metric]]\n" + limit + "\"uav2\""}});
  const Command size = tether({"size", scenario, "--axis", "uavs", "--success", "0.5",
                               "--confidence", "0.8", "--max-trials", "12", "--out", out_},
                              mark_);
  const Output output = run(size);
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, testing::StartsWith("This board carries 1 UAV ")) << output.out;
  const auto answer = nlohmann::json::parse(read_text(out_ / "size.json"));
  EXPECT_EQ(answer["answer"]["carried"], 1);
  EXPECT_EQ(answer["flights"].size(), 8u);
  EXPECT_TRUE(std::filesystem::exists(out_ / "report.html"));
  const Output again = run(with(size, {"--resume"}));
  EXPECT_EQ(again.out, output.out) << "the flights are there";
}

}  // namespace
}  // namespace tether::system_test
