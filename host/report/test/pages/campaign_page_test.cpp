#include "campaign_fixture.h"
#include "sample_record.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <tether/record/png.h>
#include <tether/record/writer.h>
#include <tether/report/report.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;

// The texts between each `open` and the next `close`.
std::vector<std::string> between(const std::string& text, const std::string& open,
                                 const std::string& close) {
  std::vector<std::string> found;
  for (auto at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const auto begin = at + open.size();
    const auto end = text.find(close, begin);
    if (end == std::string::npos) break;
    found.push_back(text.substr(begin, end - begin));
  }
  return found;
}

// References to anything outside the page.
std::vector<std::string> external_references(const std::string& page) {
  std::vector<std::string> found;
  for (const char* attribute : {" src=\"", " href=\"", " href='", "url(", "@import"}) {
    for (const std::string& target : between(page, attribute, "\n")) {
      if (!target.starts_with("#") && !target.starts_with("data:"))
        found.push_back(target.substr(0, 60));
    }
  }
  return found;
}

// Ids that occur more than once.
std::vector<std::string> repeated_ids(const std::string& page) {
  std::vector<std::string> repeated;
  std::set<std::string> seen;
  for (const char* quote : {"\"", "'"}) {
    for (const std::string& id : between(page, std::string(" id=") + quote, quote)) {
      if (!seen.insert(id).second) repeated.push_back(id);
    }
  }
  return repeated;
}

void write_record(const std::filesystem::path& file, const record::Record& record) {
  const auto recorder = record::make_mcap_recorder(file);
  recorder->write(record.header);
  for (std::size_t i = 0; i < record.interactions.size(); ++i) {
    recorder->write(record.ground_truth[i].at, record.ground_truth[i].message);
    recorder->write(record.annotations[i].at, record.annotations[i].message);
    recorder->write(record.interactions[i].at, record.interactions[i].message);
  }
  for (const auto& contact : record.contacts) recorder->write(contact.at, contact.message);
  for (const auto& image : record.images) recorder->write(image.at, image.message);
  for (const auto& image : record.raw_images) recorder->write(image.at, image.message);
  recorder->write(record::Footer{});
}

class CampaignPage : public CampaignFixture {
 protected:
  void write_records() {
    for (const char* condition : {"host", "target"}) {
      record::Record record = sample_record(30);
      record.header.condition = condition;
      record.header.reports_contacts = true;
      const SimTime end = record.interactions.back().at;
      record.contacts = {{end, 0, {"uav1", end, "<wall>", 3.8}}};
      const std::vector<std::uint8_t> grey(12 * 8 * 3, 77);
      for (std::uint64_t i = 0; i < 9; ++i) {
        const SimTime at = record.interactions.back().at;
        record.images.push_back(
            {at, i, {"uav1", "camera", at, i, record::encode_png(12, 8, grey)}});
        record.raw_images.push_back(
            {at, i, {"uav1", "depth", at, i, 2, 1, std::vector<float>{1.0F, 2.0F}}});
      }
      write_record(folder_of(condition, 1) / "record.mcap", record);
      campaign::TrialResult flown = campaign::read_result(folder_of(condition, 1));
      flown.pace = Pace{.uav = "uav1", .stages = {{.stage = "detect", .share = 1.0}}};
      write(flown);
    }
  }
  std::string page() const { return campaign_page(all(), out_); }
  // What screen readers and keyboards need: one h1, no level of headings left out, headings of
  // tables with their scope, what scrolls can be reached; both
  // have names.
  static void expect_readable(const std::string& html) {
    EXPECT_EQ(between(html, "<h1>", "</h1>").size(), 1u);
    char level = '1';
    for (const std::string& tag : between(html, "<h", ">")) {
      if (tag.size() != 1 || tag[0] < '1' || tag[0] > '6') continue;
      EXPECT_LE(tag[0], level + 1);
      level = tag[0];
    }
    for (const std::string& attributes : between(html, "<th", ">"))
      EXPECT_TRUE(attributes == "ead" || attributes.starts_with(" scope=")) << attributes;
    for (const std::string& attributes : between(html, "<div class=\"scroll\"", ">"))
      EXPECT_THAT(attributes, MatchesRegex(" role=\"group\" tabindex=\"0\" aria-label=\"[^\"]+\""));
    for (const std::string& table : between(html, "<table", "<tbody>"))
      EXPECT_TRUE(table.starts_with(" aria-label=\"") || table.starts_with(">\n<caption>"))
          << table;
    EXPECT_EQ(between(html, "<main>", "</main>").size(), 1u);
  }
  // Of what every page has: valid drawings, unique ids, nothing outside the page.
  static void check_page(const std::string& html, std::size_t drawings) {
    const auto found = between(html, "<svg", "</svg>");
    EXPECT_EQ(found.size(), drawings);
    for (const std::string& drawing : found) {
      tinyxml2::XMLDocument document;
      EXPECT_EQ(document.Parse(("<svg" + drawing + "</svg>").c_str()), tinyxml2::XML_SUCCESS);
      EXPECT_THAT(drawing, HasSubstr("aria-label="));
    }
    EXPECT_THAT(repeated_ids(html), IsEmpty());
    EXPECT_THAT(external_references(html), IsEmpty());
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("<link")));
    expect_readable(html);
  }
  static void expect_in_order(const std::string& html, const std::vector<std::string>& parts) {
    std::size_t from = 0;
    for (const std::string& part : parts) {
      const auto at = html.find(part, from);
      ASSERT_NE(at, std::string::npos) << part;
      from = at;
    }
  }
};

TEST_F(CampaignPage, HasItsPartsInReadingOrder) {
  write_records();
  const std::string html = page();
  expect_in_order(
      html,
      {"<h1>study</h1>", "<strong>Fast enough so far</strong>: on “target” 3 of 3",
       "<h2>What to do", "<svg", "turn (the paper&#39;s Table III)",
       "<caption>What was compared in turn</caption>", "all stages",
       "<caption>Table III: Performance of", "<h3>Optimism of the unsynchronised test</h3>",
       "<p>Without synchronisation, “target” does not",
       "<caption>Optimism of the unsynchronised test of turn</caption>", "<h3>All trials</h3>",
       "<h3>Path, seen from above</h3>", "<h3>Simulated and execution time over wall time</h3>",
       "<h3>Camera images</h3>", "<summary>All statistics</summary>",
       "<summary>Differences between the conditions</summary>", "<h2>Setup and checks</h2>",
       "a machine"});
  check_page(html,
             14);  // flights, two metrics, the path, two timelines, four images, four of depths
  EXPECT_THAT(html, HasSubstr("data:image/jpeg;base64,"));
  EXPECT_EQ(html, page());
}

TEST_F(CampaignPage, ListsFailuresAndNotesOnTop) {
  write(campaign::make_setup_failure(scenario(), *scenario().find_condition("target"), 2,
                                     "no <free> port"));
  campaign::TrialResult noted = trial("target", 3, 2, 7.2);
  noted.this_run.notes = {"process <7> was stopped"};
  write(noted);
  expect_in_order(page(),
                  {"1 flight failed and is not counted: ", "<h2>Problems</h2>",
                   "turn, target, seed 2: failed, excluded from all means: no &lt;free&gt; "
                   "port",
                   "turn, target, seed 3: process &lt;7&gt; was stopped", "What was compared",
                   "Note: target, seed 3: process &lt;7&gt; was stopped."});
  EXPECT_THAT(run_page(folder_of("target", 3)),
              HasSubstr("turn, target, seed 3: process &lt;7&gt; was stopped"));
}

TEST_F(CampaignPage, WithoutRecordsHasTablesAndDistributions) {
  const std::string html = page();
  EXPECT_THAT(html, Not(HasSubstr("<h2>Problems</h2>")));
  check_page(html, 3);
  scratch_.write("out/turn/host/seed-0001/record.mcap", "no record");
  expect_in_order(page(), {"<h2>Problems</h2>", "seed-0001/record.mcap"});
}

TEST_F(CampaignPage, BeforeTheFirstTrialIsAPage) {
  std::filesystem::remove_all(out_ / "turn");
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("seeds 1, 2 and 3"));
  check_page(html, 0);
}

TEST_F(CampaignPage, OfOneRunShowsItsOutcomeAndPlots) {
  write_records();
  const std::string html = run_page(folder_of("target", 1));
  expect_in_order(
      html,
      {"<h1>turn, target, seed 1</h1>", "<strong>Fast enough in this flight</strong>: on “target”",
       "Goal reached: every SUT reached its goal within the limits. The SUT of uav1 "
       "reports: the anchor is in the middle.",
       "Time required (s)", "<h2>Contacts</h2>", "&lt;wall&gt;", "2.930", "3.800",
       "<h2>Camera images</h2>"});
  check_page(html, 14);  // flight, timeline twice, lag, path, motion, four images, four of depths
}

TEST_F(CampaignPage, OfOneRunDoesNotNeedARecordButAResult) {
  expect_in_order(run_page(folder_of("target", 1)),
                  {"No plots: " + (folder_of("target", 1) / "record.mcap").string()});
  EXPECT_EQ(bad_file_error([&] { run_page(out_); }).where().file, out_ / "result.json");
}

}  // namespace
}  // namespace tether::report
