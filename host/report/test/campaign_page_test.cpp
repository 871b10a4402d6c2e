#include "page_check.h"
#include "sample_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/record/png.h>
#include <tether/record/writer.h>
#include <tether/report/page.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

void write_record(const std::filesystem::path& file, const record::Record& record) {
  const auto recorder = record::make_mcap_recorder(file);
  recorder->write(record.header);
  for (std::size_t i = 0; i < record.interactions.size(); ++i) {
    recorder->write(record.ground_truth[i].at, record.ground_truth[i].message);
    recorder->write(record.annotations[i].at, record.annotations[i].message);
    recorder->write(record.interactions[i].at, record.interactions[i].message);
  }
  for (const auto& image : record.images) recorder->write(image.at, image.message);
  recorder->write(record::Footer{});
}

class CampaignPage : public testing::Test {
 protected:
  CampaignPage() {
    campaign::CampaignFolder folder(out_, campaign_, {{"tether", "0.1.0"}},
                                    campaign::OpenMode::kFresh);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const double s = static_cast<double>(seed);
      write(campaign::make_trial(scenario(), "host", seed, 0, 2.4 + 0.1 * s));
      write(campaign::make_trial(scenario(), "target", seed, 2, 7.0 + 0.1 * s));
      write(campaign::make_trial(scenario(), "target, no sync", seed, 0, 2.3 + 0.1 * s));
    }
  }
  const scenario::Scenario& scenario() const { return campaign_.scenarios[0].scenario; }
  std::filesystem::path folder_of(const std::string& condition, std::uint64_t seed) const {
    return out_ / campaign::trial_folder("turn", condition, seed);
  }
  void write(const campaign::TrialResult& result) {
    std::filesystem::create_directories(folder_of(result.condition, result.seed));
    write_result(folder_of(result.condition, result.seed), result);
  }
  void write_records() {
    for (const char* condition : {"host", "target"}) {
      record::Record record = sample_record(30);
      record.header.condition = condition;
      const std::vector<std::uint8_t> grey(12 * 8 * 3, 77);
      for (std::uint64_t i = 0; i < 9; ++i) {
        const SimTime at = record.interactions.back().at;
        record.images.push_back(
            {at, i, {"uav1", "camera", at, i, record::encode_png(12, 8, grey)}});
      }
      write_record(folder_of(condition, 1) / "record.mcap", record);
    }
  }
  std::string page() const { return campaign_page(campaign::read_campaign_results(out_), out_); }

  ScratchFolder scratch_;
  std::filesystem::path out_ = scratch_.path("out");
  scenario::Campaign campaign_ = campaign::make_campaign(scratch_);
};

TEST_F(CampaignPage, HasItsPartsInReadingOrder) {
  write_records();
  const std::string html = page();
  std::size_t from = 0;
  for (const char* part :
       {"<h1>study</h1>", "turn (the paper&#39;s Table III)", "The software reached its goal",
        "Table III: Performance of", "What a test without synchronisation hides",
        "Without synchronisation the target looks", "The optimism of an unsynchronised test",
        "Every trial", "Path from above", "Time against time", "What the camera saw",
        "<summary>All statistics</summary>", "<summary>How the conditions differ</summary>",
        "What the numbers rest on", "a machine"}) {
    const auto at = html.find(part, from);
    ASSERT_NE(at, std::string::npos) << part;
    from = at;
  }
}

TEST_F(CampaignPage, NeedsNothingBesideIt) {
  write_records();
  const std::string html = page();
  EXPECT_THAT(external_references(html), IsEmpty());
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
}

TEST_F(CampaignPage, HasPlotsThatDoNotClash) {
  write_records();
  const std::string html = page();
  const auto drawings = between(html, "<svg", "</svg>");
  // Two metrics, the path, two timelines, four frames.
  EXPECT_EQ(drawings.size(), 9u);
  for (const std::string& drawing : drawings) {
    tinyxml2::XMLDocument document;
    const std::string svg = "<svg" + drawing + "</svg>";
    EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS);
    EXPECT_THAT(svg, HasSubstr("aria-label="));
  }
  EXPECT_THAT(repeated_ids(html), IsEmpty());
  EXPECT_THAT(html, HasSubstr("data:image/jpeg;base64,"));
}

TEST_F(CampaignPage, IsTheSameEachTime) {
  write_records();
  EXPECT_EQ(page(), page());
}

TEST_F(CampaignPage, NamesAFailedTrialOnTop) {
  write(campaign::make_setup_failure(scenario(), *scenario().find_condition("target"), 2,
                                     "no <free> port"));
  const std::string html = page();
  const auto at =
      html.find("turn, target, seed 2: failed, and is in no mean: no &lt;free&gt; port");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(at, html.find("The software reached its goal"));
}

TEST_F(CampaignPage, NamesWhatWasNotedOfARunOnTopAndBelowTheTable) {
  campaign::TrialResult noted = campaign::make_trial(scenario(), "target", 2, 2, 7.2);
  noted.this_run.notes = {"process <7> was stopped"};
  write(noted);
  const std::string html = page();
  const auto verdict = html.find("The software reached its goal");
  const auto at = html.find("turn, target, seed 2: process &lt;7&gt; was stopped");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(html.find("What is missing or went wrong"), at);
  EXPECT_LT(at, verdict);
  EXPECT_NE(html.find("Noted: target, seed 2: process &lt;7&gt; was stopped.", verdict),
            std::string::npos);
  EXPECT_THAT(run_page(folder_of("target", 2)),
              HasSubstr("turn, target, seed 2: process &lt;7&gt; was stopped"));
}

TEST_F(CampaignPage, WithoutRecordsHasTablesAndDistributions) {
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("Every trial"));
  EXPECT_THAT(html, Not(HasSubstr("Path from above")));
  EXPECT_THAT(html, Not(HasSubstr("What is missing or went wrong")));
}

TEST_F(CampaignPage, NamesARecordThatCannotBeRead) {
  scratch_.write("out/turn/host/seed-0001/record.mcap", "no record");
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("What is missing or went wrong"));
  EXPECT_THAT(html, HasSubstr("seed-0001/record.mcap"));
}

TEST_F(CampaignPage, OfNothingRunYetIsAPage) {
  std::filesystem::remove_all(out_ / "turn");
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("seeds 1, 2 and 3"));
  EXPECT_THAT(html, HasSubstr("</html>"));
}

TEST_F(CampaignPage, OfOneRunShowsItsOutcomeAndPlots) {
  write_records();
  const std::string html = run_page(folder_of("target", 1));
  EXPECT_THAT(html, HasSubstr("<h1>turn, target, seed 1</h1>"));
  EXPECT_THAT(html,
              HasSubstr("Goal reached: every SUT reached its goal within the limits. The software "
                        "of uav1 ended with: the anchor is in the middle."));
  EXPECT_THAT(html, HasSubstr("Time required (s)"));
  // Timeline twice, lag, path, four frames.
  EXPECT_EQ(between(html, "<svg", "</svg>").size(), 8u);
  EXPECT_THAT(repeated_ids(html), IsEmpty());
  EXPECT_THAT(external_references(html), IsEmpty());
}

TEST_F(CampaignPage, OfARunWithoutARecordSaysSo) {
  const std::string html = run_page(folder_of("target", 1));
  EXPECT_THAT(html, HasSubstr("No plots: "));
  EXPECT_THAT(html, HasSubstr("record.mcap"));
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { run_page(out_); }),
              HasSubstr("result.json"));
}

}  // namespace
}  // namespace tether::report
