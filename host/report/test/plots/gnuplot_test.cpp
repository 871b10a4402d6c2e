#include "sample_record.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/report/plots.h>

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

TEST(Gnuplot, ReportsMissingAndFailingPrograms) {
  const ScratchFolder folder;
  const std::string killed = folder.write("killed", "#!/bin/sh\nkill -9 $$\n");
  std::filesystem::permissions(killed, std::filesystem::perms::owner_all);
  struct Case {
    std::string program, subject, value;  ///< a value that the message has
  };
  for (const Case& c : {Case{"no-such-gnuplot", "no-such-gnuplot", "gnuplot-nox"},
                        {"gnuplot", "a line", "$nothing"},
                        {"true", "a line", ""},
                        {"false", "a line", "1"},
                        {killed, "a line", "signal 9 (Killed)"}}) {
    const Error error = thrown_error(ErrorCode::kSetup, [&] {
      draw_svg({"plot $nothing\n", "a line"}, c.program);
    });
    EXPECT_EQ(error.subject(), c.subject);
    EXPECT_THAT(error.what(), HasSubstr(c.value)) << c.program;
  }
}

}  // namespace
}  // namespace tether::report
