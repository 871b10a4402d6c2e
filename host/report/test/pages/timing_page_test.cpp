#include <gtest/gtest.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

TEST(TimingPage, HasARowAndAHistogramForEachStage) {
  timing::Timing timing;
  timing.scenario = "face_anchor";
  timing.runs = {{"uav1", 1, {}}};
  for (int i = 1; i <= 30; ++i)
    timing.runs[0].calls.push_back({"command", {{"detect <1>", Duration(i * 1'000'000)}}});
  timing.runs[0].calls.push_back({"finish", {{"once", Duration(0)}}});
  const std::string page = timing_page(timing);
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = page.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<svg"), 2u);
  EXPECT_LT(page.find("<strong>“detect &lt;1&gt;” takes 100 % of the computing time</strong>"),
            page.find("<svg"));
  EXPECT_EQ(count("detect <1>"), 0u);
  EXPECT_GE(count("detect &lt;1&gt;"), 2u);
  EXPECT_EQ(count("<rect"), 31u);  // 30 times in bins of their own, and one stage of no time
}

TEST(TimingCsv, HasARowInSecondsForEachStage) {
  timing::Timing timing;
  timing.runs = {{"uav1", 1, {}}};
  for (int i = 1; i <= 101; ++i)
    timing.runs[0].calls.push_back({"command", {{"detect, \"fine\"", Duration(i * 1'000'000)}}});
  EXPECT_EQ(timing_csv(timing::stage_rows(timing)),
            "stage,count,median_s,p95_s,p99_s,worst_s,share\r\n"
            "\"detect, \"\"fine\"\"\",101,0.051,0.096,0.1,0.101,1\r\n");
}

}  // namespace
}  // namespace tether::report
