#include "support/trials.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether report` and `tether plot` on what real runs left.
namespace tether::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class ReportCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    write_hover_scenario(folder_->path(), "good");
    write_text(*folder_ / "campaign.toml",
               "name = \"small\"\ntrials = 2\n\n[[scenario]]\nfile = \"hover.toml\"\n");
    const Output output =
        run(tether({"campaign", *folder_ / "campaign.toml", "--out", *folder_ / "out"}));
    ASSERT_EQ(output.code, 0) << output.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path out() { return *folder_ / "out"; }
  static std::filesystem::path one() { return out() / "hover/slow/seed-0001"; }
  /// Where no other program is found.
  static Command without_programs(std::vector<std::string> arguments) {
    Command command = tether(arguments);
    command.environment.emplace_back("PATH", "/nonexistent");
    return command;
  }
  static std::size_t drawings(const std::string& text) {
    std::size_t count = 0;
    for (auto at = text.find("<svg"); at != std::string::npos; at = text.find("<svg", at + 1))
      ++count;
    return count;
  }

  static inline std::unique_ptr<TempFolder> folder_;
};

TEST_F(ReportCommand, MakesOnePageOfACampaign) {
  const Output output = run(tether({"report", out(), "--format", "html"}));
  ASSERT_EQ(output.code, 0) << output.err;
  const std::string page = read_text(out() / "report.html");
  EXPECT_EQ(drawings(page), 4u);  // one metric, the path, a timeline of each condition
  EXPECT_THAT(page, AllOf(HasSubstr("“host”"), HasSubstr("“slow”")));
  EXPECT_EQ(run(tether({"campaign", *folder_ / "campaign.toml", "--out", out(), "--resume"})).code,
            0);
}

TEST_F(ReportCommand, NamesAPlantedFailure) {
  const std::filesystem::path copy = *folder_ / "planted";
  std::filesystem::copy(out(), copy, std::filesystem::copy_options::recursive);
  const std::filesystem::path result = copy / "hover/host/seed-0002/result.json";
  nlohmann::json json = nlohmann::json::parse(read_text(result));
  json["outcome"] = "failed";
  json["reason"] = "planted for the test";
  write_text(result, json.dump());
  ASSERT_EQ(run(tether({"report", copy, "--format", "html"})).code, 0);
  EXPECT_THAT(read_text(copy / "report.html"), HasSubstr("planted for the test"));
}

TEST_F(ReportCommand, MakesAPageOfOneRun) {
  const std::filesystem::path file = *folder_ / "one.html";
  const Output output = run(tether({"report", one(), "--format", "html", "--out", file}));
  ASSERT_EQ(output.code, 0) << output.err;
  const std::string page = read_text(file);
  EXPECT_EQ(drawings(page), 4u);  // timeline twice, lag, path
  EXPECT_THAT(page, HasSubstr("slow"));
  EXPECT_FALSE(std::filesystem::exists(one() / "report.html"));
}

TEST_F(ReportCommand, WritesTablesToAFileAsToTheTerminal) {
  for (const char* format : {"text", "markdown", "csv", "summary-csv"}) {
    const std::filesystem::path file = *folder_ / "tables.txt";
    const Output shown = run(tether({"report", out(), "--format", format}));
    ASSERT_EQ(shown.code, 0) << shown.err;
    ASSERT_EQ(run(tether({"report", out(), "--format", format, "--out", file})).code, 0);
    EXPECT_EQ(read_text(file), shown.out) << format;
    EXPECT_EQ(run(tether({"report", one(), "--format", format})).code, 0) << format;
  }
}

TEST_F(ReportCommand, SummariesHaveARowPerConditionAndMetric) {
  const Output csv = run(tether({"report", out(), "--format", "summary-csv"}));
  EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 3);
  EXPECT_THAT(csv.out, HasSubstr("hover,slow,time_required,s,2,2,"));
}

TEST_F(ReportCommand, PlotsARun) {
  const Output output = run(tether({"plot", one() / "record.mcap", "--out", *folder_ / "plots"}));
  ASSERT_EQ(output.code, 0) << output.err;
  for (const char* name : {"timeline.svg", "timeline_zoom.svg", "lag.svg", "path.svg"})
    EXPECT_EQ(drawings(read_text(*folder_ / "plots" / name)), 1u) << name;
}

TEST_F(ReportCommand, WithoutGnuplotSaysSoAndWritesNothing) {
  const std::filesystem::path file = *folder_ / "none.html", plots = *folder_ / "no-plots";
  const Output page = run(without_programs({"report", out(), "--format", "html", "--out", file}));
  EXPECT_EQ(page.code, 3);
  EXPECT_THAT(page.err, HasSubstr("gnuplot-nox"));
  EXPECT_FALSE(std::filesystem::exists(file));
  const Output plot = run(without_programs({"plot", one() / "record.mcap", "--out", plots}));
  EXPECT_EQ(plot.code, 3);
  EXPECT_THAT(plot.err, HasSubstr("gnuplot-nox"));
  EXPECT_FALSE(std::filesystem::exists(plots));
  EXPECT_EQ(run(without_programs({"report", out()})).code, 0);
}

TEST_F(ReportCommand, OfBadInputLeavesNothing) {
  const std::filesystem::path empty = *folder_ / "empty";
  std::filesystem::create_directories(empty);
  const Output page = run(tether({"report", empty, "--format", "html"}));
  EXPECT_EQ(page.code, 2);
  EXPECT_THAT(page.err, HasSubstr(empty.string()));
  EXPECT_TRUE(std::filesystem::is_empty(empty));
  write_text(empty / "record.mcap", "no record");
  const Output plot = run(tether({"plot", empty / "record.mcap"}));
  EXPECT_EQ(plot.code, 2);
  EXPECT_THAT(plot.err, HasSubstr("record.mcap"));
  EXPECT_FALSE(std::filesystem::exists(empty / "plots"));
  for (const char* format : {"text", "html"}) {
    const Output killed = run(tether({"report", empty, "--format", format}));
    EXPECT_EQ(killed.code, 2);
    EXPECT_THAT(killed.err, StartsWith("tether: " + empty.string() + ": "));
    EXPECT_THAT(killed.err, HasSubstr((empty / "record.mcap").string()));
  }
  const Output nowhere =
      run(tether({"report", out(), "--out", *folder_ / "no/such/folder/report.txt"}));
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_THAT(nowhere.err, HasSubstr("no/such/folder"));
}

}  // namespace
}  // namespace tether::system_test
