#include "support/trials.h"

#include <algorithm>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether campaign` and `tether report`: two conditions, two seeds.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// In the order in which they are run.
const std::vector<std::string> kTrials = {"hover/host/seed-0001", "hover/slow/seed-0001",
                                          "hover/host/seed-0002", "hover/slow/seed-0002"};

class Campaign : public testing::Test {
 protected:
  Campaign() {
    write_hover_scenario(folder_.path(), "good");
    write_text(folder_ / "campaign.toml",
               "name = \"small\"\ntrials = 2\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  }
  Command campaign(const std::vector<std::string>& options = {},
                   const std::string& mark = "none") const {
    std::vector<std::string> words = {"campaign", folder_ / "campaign.toml", "--out",
                                      folder_ / "out"};
    words.insert(words.end(), options.begin(), options.end());
    return tether(words, mark);
  }
  std::filesystem::path trial(const std::string& name) const { return folder_ / "out" / name; }
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const std::string& name : kTrials) texts.push_back(read_text(trial(name) / "result.json"));
    return texts;
  }
  /// The SUT is a script, given to its shell as an argument, that does `more` first.
  void write_script_sut(const std::string& more) const {
    const std::string program = bad_sut_program().string();
    write_text(folder_ / "sut.sh", more + "\nexec '" + program + "' \"$@\"\n");
    write_hover_scenario(
        folder_.path(), "good",
        {{"\"" + program + "\"", "\"/bin/sh\", \"" + (folder_ / "sut.sh").string() + "\""}});
  }
  Output report(const std::string& format) const {
    return run(tether({"report", folder_ / "out", "--format", format}));
  }

  TempFolder folder_;
};

TEST_F(Campaign, RunsEveryTrialAndReports) {
  const Output output = run(campaign());
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("host"));
  EXPECT_THAT(output.out, HasSubstr("slow"));
  for (const std::string& name : kTrials) {
    EXPECT_EQ(read_result(trial(name))["outcome"], "goal_reached") << name;
    EXPECT_EQ(run(tether({"audit", trial(name) / "record.mcap"})).code, 0) << name;
  }

  const Output text = report("text");
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.out, HasSubstr("slow"));
  const Output markdown = report("markdown");
  EXPECT_EQ(markdown.code, 0);
  EXPECT_THAT(markdown.out, HasSubstr("|"));
  EXPECT_THAT(markdown.out, HasSubstr("host"));
  const Output csv = report("csv");
  EXPECT_EQ(csv.code, 0);
  // One row for each trial and metric, and the head.
  EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 5);
  EXPECT_THAT(csv.out, HasSubstr("time_required"));
}

TEST_F(Campaign, ResumesWithWhatIsMissing) {
  ASSERT_EQ(run(campaign()).code, 0);
  const auto before = texts();
  std::filesystem::remove(trial(kTrials[1]) / "result.json");
  write_text(trial(kTrials[2]) / "result.json", before[2].substr(0, before[2].size() / 2));

  const Output output = run(campaign({"--resume"}));
  EXPECT_EQ(output.code, 0) << output.err;
  const auto after = texts();
  EXPECT_EQ(after[0], before[0]);
  EXPECT_EQ(after[3], before[3]);
  for (const std::size_t again : {1u, 2u})
    EXPECT_EQ(nlohmann::json::parse(after[again])["end"], "finished");
  EXPECT_THAT(output.err, HasSubstr(kTrials[2]));
}

TEST_F(Campaign, RefusesAFolderThatHoldsResults) {
  ASSERT_EQ(run(campaign()).code, 0);
  const auto before = texts();
  const Output output = run(campaign());
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  EXPECT_EQ(texts(), before);
}

TEST_F(Campaign, RefusesToResumeUnderOtherSettings) {
  ASSERT_EQ(run(campaign()).code, 0);
  const auto before = texts();
  write_hover_scenario(folder_.path(), "good", {{"time_limit_s = 5", "time_limit_s = 6"}});
  const Output output = run(campaign({"--resume"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("hover.toml"));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  EXPECT_EQ(texts(), before);
}

TEST_F(Campaign, EndsWhenAFileIsEditedMeanwhile) {
  const std::string scenario = folder_ / "hover.toml";
  write_script_sut("echo '# edited' >> '" + scenario + "'");
  const Output output = run(campaign());
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr(scenario + ": "));
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  for (const std::string& name : kTrials)
    EXPECT_FALSE(std::filesystem::exists(trial(name) / "result.json")) << name;
}

TEST_F(Campaign, RefusesToResumeWithAnotherScriptOfTheSut) {
  write_script_sut("# first");
  ASSERT_EQ(run(campaign()).code, 0);
  write_script_sut("# second");
  const Output output = run(campaign({"--resume"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("sut.sh"));
}

TEST_F(Campaign, RefusesToResumeWithFewerTrials) {
  ASSERT_EQ(run(campaign()).code, 0);
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  const Output output = run(campaign({"--resume"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("seed 2"));
}

/// scripts/reproduce with a campaign that ends as told in place of the paper's.
struct ReproduceCase {
  const char* what;
  const char* campaign;
  const char* report;
  int code;
  bool has_page;
};

TEST_F(Campaign, OfThePaperIsReportedWhateverFailed) {
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
    const Output output =
        run(Command{.arguments = {"bash", root / "scripts/reproduce", root / "out"},
                    .environment = {},
                    .working_folder = {}});
    EXPECT_EQ(output.code, c.code) << c.what << output.err;
    EXPECT_EQ(std::filesystem::exists(root / "out/report.html"), c.has_page) << c.what;
  }
}

TEST_F(Campaign, GoesOnAfterCtrlC) {
  const std::string mark = "campaign" + std::to_string(getpid());
  Process process(campaign({}, mark));
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!std::filesystem::exists(trial(kTrials[0]) / "result.json")) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    ASSERT_FALSE(process.has_ended()) << process.err();
    std::this_thread::sleep_for(5ms);
  }
  process.signal(SIGINT);
  const Output output = process.wait(15s);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  EXPECT_TRUE(wait_until_gone(mark));
  const std::string first = read_text(trial(kTrials[0]) / "result.json");
  EXPECT_FALSE(std::filesystem::exists(trial(kTrials[3]) / "result.json"));

  const Output resumed = run(campaign({"--resume"}));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(read_text(trial(kTrials[0]) / "result.json"), first);
  for (const std::string& name : kTrials)
    EXPECT_EQ(read_result(trial(name))["outcome"], "goal_reached") << name;
}

TEST_F(Campaign, RunsSideBySide) {
  const Output output = run(campaign({"--jobs", "2"}));
  EXPECT_EQ(output.code, 0) << output.err;
  for (const std::string& name : kTrials)
    EXPECT_EQ(run(tether({"audit", trial(name) / "record.mcap"})).code, 0) << name;
}

TEST_F(Campaign, LeavesNothingRunningWhenItIsKilled) {
  const std::string mark = "killed campaign" + std::to_string(getpid());
  Process process(campaign({}, mark));
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (processes_with_mark(mark).size() < 3) {  // campaign, trial, SUT
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    std::this_thread::sleep_for(1ms);
  }
  process.signal(SIGKILL);
  process.wait(5s);
  EXPECT_TRUE(wait_until_gone(mark));

  EXPECT_EQ(run(campaign({"--resume"})).code, 0);
  for (const std::string& name : kTrials) EXPECT_EQ(read_result(trial(name))["end"], "finished");
}

TEST_F(Campaign, CountsTrialsThatFailAndGoesOn) {
  write_hover_scenario(folder_.path(), "crash");
  const Output output = run(campaign());
  EXPECT_EQ(output.code, 3);
  for (const std::string& name : kTrials)
    EXPECT_EQ(read_result(trial(name))["end"], "sut_lost") << name;
  EXPECT_EQ(report("text").code, 0);
}

TEST_F(Campaign, WithAWrongKeyIsRefused) {
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrails = 2\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  const Output output = run(campaign());
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr((folder_ / "campaign.toml").string() + ":2:"));
  EXPECT_THAT(output.err, HasSubstr("trials"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace tether::system_test
