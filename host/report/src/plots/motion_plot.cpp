#include "plots/plot_script.h"

#include <cmath>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr std::size_t kDrawnPoints = 600;

}  // namespace

std::optional<Plot> motion_plot(const PlottedRun& run) {
  std::vector<const record::GroundTruth*> truth;
  for (const auto& logged : run.record->ground_truth)
    if (logged.message.uav == run.uav) truth.push_back(&logged.message);
  if (truth.size() < 2) return std::nullopt;
  DataBlock height("height"), speed("speed");
  for (const std::size_t i : thinned(truth.size(), kDrawnPoints)) {
    const double at_s = to_seconds(truth[i]->at);
    const auto& v = truth[i]->v_WB_m_s;
    height.add(at_s, truth[i]->p_WB_m[2]);
    speed.add(at_s, std::hypot(v[0], v[1], v[2]));
  }
  Drawing drawing;
  drawing.add(height, "with lines linewidth 1.8", series_ink(run.series), "height (m)");
  drawing.add(speed, "with lines linewidth 1.2 dashtype '-'", Ink::kForeground, "speed (m/s)");
  return Plot{frame_script({.x_label = "Simulated time (s)", .y_label = "Height, speed"}) +
                  "set offsets graph 0, graph 0, graph 0.06, graph 0.06\n" + drawing.script(),
              fmt::format("Height and speed over simulated time, {}", run.label)};
}

}  // namespace tether::report
