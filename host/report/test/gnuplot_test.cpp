#include "sample_record.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/report/gnuplot.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

bool is_well_formed(const std::string& xml) {
  tinyxml2::XMLDocument document;
  return document.Parse(xml.c_str(), xml.size()) == tinyxml2::XML_SUCCESS;
}

TEST(Gnuplot, DrawsEveryPlotOfARun) {
  const record::Record record = sample_record(30);
  const PlottedRun run{&record, "uav1", "a <b> & 'c'", 1};
  for (const auto& plot : {timeline_plot(run, Extent::kWhole), lag_plot(run),
                           timeline_plot(run, Extent::kFirstInteractions), path_plot({{run}})}) {
    ASSERT_TRUE(plot);
    const std::string svg = draw_svg(*plot);
    EXPECT_TRUE(is_well_formed(svg)) << plot->title;
    EXPECT_THAT(svg, HasSubstr("tp-color-4")) << plot->title;
    EXPECT_THAT(svg, Not(HasSubstr("rgb(  1")));
    EXPECT_EQ(svg, draw_svg(*plot));
  }
}

TEST(Gnuplot, DrawsALongRecordSmall) {
  const record::Record record = sample_record(100'000);
  const PlottedRun run{&record, "uav1", "target", 1};
  constexpr std::size_t kMost = 300'000;
  for (const auto& plot : {timeline_plot(run, Extent::kWhole), lag_plot(run), path_plot({{run}})})
    EXPECT_LT(draw_svg(plot.value()).size(), kMost);
}

TEST(Gnuplot, ThatIsMissingIsNamedWithItsPackage) {
  const std::string message = error_message(ErrorCode::kSetup, [] {
    draw_svg({"plot x\n", "a line"}, "no-such-gnuplot");
  });
  EXPECT_THAT(message, HasSubstr("'no-such-gnuplot' is not installed"));
  EXPECT_THAT(message, HasSubstr("gnuplot-nox"));
}

TEST(Gnuplot, ThatRefusesSaysWhy) {
  const std::string message = error_message(ErrorCode::kSetup, [] {
    draw_svg({"plot $nothing\n", "a line"});
  });
  EXPECT_THAT(message, HasSubstr("could not draw \"a line\""));
  EXPECT_THAT(message, HasSubstr("nothing"));
}

TEST(Gnuplot, ThatSaysNothingIsToldByItsEnd) {
  const auto message_with = [](const std::string& program) {
    return error_message(ErrorCode::kSetup, [&] { draw_svg({"plot x\n", "a line"}, program); });
  };
  const ScratchFolder folder;
  const std::string killed = folder.write("killed", "#!/bin/sh\nkill -9 $$\n");
  std::filesystem::permissions(killed, std::filesystem::perms::owner_all);
  EXPECT_THAT(message_with("true"), HasSubstr("could not draw \"a line\": no whole picture"));
  EXPECT_THAT(message_with("false"), HasSubstr("exit code 1"));
  EXPECT_THAT(message_with(killed), HasSubstr("ended by signal 9 (Killed)"));
}

}  // namespace
}  // namespace tether::report
