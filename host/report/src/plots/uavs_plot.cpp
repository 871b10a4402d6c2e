#include "plots/plot_script.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tether/report/size_report.h>

namespace tether::report {

Plot uavs_plot(const UavsReport& report) {
  const auto least = static_cast<double>(report.question.least),
             most = static_cast<double>(report.question.most);
  DataBlock shares("shares"), wanted("wanted");
  for (const sizing::UavLevel& level : uav_levels(report.points)) {
    const sizing::Share share = level.share(report.question.confidence);
    shares.add(static_cast<double>(level.uavs), share.estimate, share.low, share.high);
  }
  wanted.add(least - 0.5, report.question.success);
  wanted.add(most + 0.5, report.question.success);
  Drawing drawing;
  drawing.add(wanted, "with lines linewidth 1 dashtype '.'", Ink::kForeground, "wanted");
  if (!shares.empty())
    drawing.add(shares, "with yerrorbars pointtype 7 pointsize 0.8 linewidth 1.5", series_ink(0),
                "flights");
  const Frame frame{.x_label = fmt::format("UAVs on “{}”", report.board),
                    .y_label = "goal reached"};
  return {frame_script(frame) + range_script("x", least - 0.5, most + 0.5) +
              fmt::format("set xtics {}\n", std::max(1.0, std::floor((most - least) / 16))) +
              range_script("y", -0.05, 1.05) +
              "set ytics ('0 %%' 0, '25 %%' 0.25, '50 %%' 0.5, '75 %%' 0.75, '100 %%' 1)\n" +
              drawing.script(),
          fmt::format("Flights of {} that reach the goal, over the number of UAVs on the board",
                      report.scenario)};
}

}  // namespace tether::report
