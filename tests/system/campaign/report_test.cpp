#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether report` and `tether plot` on what real runs left. The contents: host/report/test.
namespace tether::system_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::StartsWith;

std::size_t drawings(const std::string& text) {
  std::size_t count = 0;
  for (auto at = text.find("<svg"); at != std::string::npos; at = text.find("<svg", at + 1))
    ++count;
  return count;
}

class ReportCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    write_hover_scenario(folder_->path(), "good");
    const Output output =
        run(tether({"campaign", write_campaign(folder_->path(), 2), "--out", *folder_ / "out"}));
    ASSERT_EQ(output.code, 0) << output.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path out() { return *folder_ / "out"; }
  static std::filesystem::path one() { return out() / "hover/slow/seed-0001"; }

  static inline std::unique_ptr<TempFolder> folder_;
};

TEST_F(ReportCommand, MakesAPageOfACampaignAndOfARun) {
  ASSERT_EQ(run(tether({"report", out(), "--format", "html"})).code, 0);
  const std::string page = read_text(out() / "report.html");
  EXPECT_EQ(drawings(page), 5u);  // all flights, one metric, the path, a timeline of each condition
  EXPECT_THAT(page, HasSubstr("“slow”"));
  EXPECT_EQ(run(tether({"campaign", *folder_ / "campaign.toml", "--out", out(), "--resume"})).code,
            0);

  const auto file = *folder_ / "one.html";
  ASSERT_EQ(run(tether({"report", one(), "--format", "html", "--out", file})).code, 0);
  EXPECT_EQ(drawings(read_text(file)), 6u);  // the flight, timeline twice, lag, path, motion
  EXPECT_FALSE(std::filesystem::exists(one() / "report.html"));
}

TEST_F(ReportCommand, WritesTablesToAFileAsToTheTerminal) {
  for (const auto& [format, lines] :
       {std::pair{"text", 0}, {"markdown", 0}, {"csv", 1 + 4}, {"summary-csv", 1 + 2}}) {
    const auto file = *folder_ / "tables.txt";
    const Output shown = run(tether({"report", out(), "--format", format}));
    ASSERT_EQ(shown.code, 0) << shown.err;
    EXPECT_THAT(shown.out, HasSubstr("slow"));
    EXPECT_TRUE(lines == 0 || std::ranges::count(shown.out, '\n') == lines) << format;
    ASSERT_EQ(run(tether({"report", out(), "--format", format, "--out", file})).code, 0);
    EXPECT_EQ(read_text(file), shown.out) << format;
    EXPECT_EQ(run(tether({"report", one(), "--format", format})).code, 0) << format;
  }
}

TEST_F(ReportCommand, PlotsARun) {
  const Output output = run(tether({"plot", one() / "record.mcap", "--out", *folder_ / "plots"}));
  ASSERT_EQ(output.code, 0) << output.err;
  for (const char* name :
       {"timeline.svg", "timeline_zoom.svg", "lag.svg", "motion.svg", "path.svg"})
    EXPECT_EQ(drawings(read_text(*folder_ / "plots" / name)), 1u) << name;
}

TEST_F(ReportCommand, WithoutGnuplotEndsWithThreeAndWritesNothing) {
  const Variables no_programs{{"PATH", "/nonexistent"}};
  const auto file = *folder_ / "none";
  for (const Command& command : {tether({"report", out(), "--format", "html", "--out", file}),
                                 tether({"plot", one() / "record.mcap", "--out", file})}) {
    const Output output = run(with(command, {}, no_programs));
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, HasSubstr("gnuplot-nox"));
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_EQ(run(with(tether({"report", out()}), {}, no_programs)).code, 0);
}

TEST_F(ReportCommand, OfBadInputLeavesNothing) {
  const auto expect_refused = [](const std::vector<std::string>& arguments, int code,
                                 const std::string& named) {
    const Output output = run(tether(arguments));
    EXPECT_EQ(output.code, code);
    EXPECT_THAT(output.err, StartsWith("tether: " + named));
  };
  const auto empty = *folder_ / "empty", record = empty / "record.mcap";
  std::filesystem::create_directories(empty);
  expect_refused({"report", empty, "--format", "html"}, 2, empty);
  EXPECT_TRUE(std::filesystem::is_empty(empty));
  write_text(record, "no record");
  expect_refused({"plot", record}, 2, record);
  EXPECT_FALSE(std::filesystem::exists(empty / "plots"));
  for (const char* format : {"text", "html"})
    expect_refused({"report", empty, "--format", format}, 2, empty.string() + ": ");
  const auto nowhere = *folder_ / "no/such/folder/report.txt";
  expect_refused({"report", out(), "--out", nowhere}, 3, nowhere);
}

}  // namespace
}  // namespace tether::system_test
