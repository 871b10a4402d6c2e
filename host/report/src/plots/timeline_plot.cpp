#include "plots/plot_script.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr std::size_t kFirst = 20;
constexpr std::size_t kDrawn = 400;    // of a whole run
constexpr std::size_t kBuckets = 700;  // of the lag

std::vector<const record::Interaction*> interactions_of(const PlottedRun& run) {
  std::vector<const record::Interaction*> found;
  for (const auto& logged : run.record->interactions) {
    if (logged.message.uav == run.uav) found.push_back(&logged.message);
  }
  return found;
}

bool is_synchronised(const PlottedRun& run) {
  return run.record->header.policy != record::kFreeRunning;
}

// Timeline.

bool has_wall_times(const record::Interaction* interaction) {
  return interaction->wall_at_arrival != WallTime{} && interaction->wall_at_release != WallTime{};
}

std::vector<const record::Interaction*> chosen(const PlottedRun& run, Extent extent) {
  std::vector<const record::Interaction*> all = interactions_of(run), kept;
  std::erase_if(all, [](const auto* interaction) { return !has_wall_times(interaction); });
  const std::size_t count =
      extent == Extent::kFirstInteractions ? std::min(all.size(), kFirst) : all.size();
  for (const std::size_t i : thinned(count, kDrawn)) kept.push_back(all[i]);
  return kept;
}

struct Lines {
  DataBlock st{"st"}, et{"et"}, marks{"marks"}, real_time{"real"};
  double wall_end_s = 0.0, top_s = 0.0;
};

// ET does not advance between a request and its reply, and resumes with the reply's timestamp.
void add_interaction(Lines& lines, const record::Interaction& i, WallTime wall_zero,
                     bool synchronised) {
  const double arrival_s = to_seconds(i.wall_at_arrival - wall_zero);
  const double release_s = to_seconds(i.wall_at_release - wall_zero);
  const double request_s = to_seconds(i.request_at), reply_s = to_seconds(i.reply_at);
  lines.st.add(arrival_s, to_seconds(i.st_at_arrival));
  lines.st.add(release_s, to_seconds(i.st_at_release));
  lines.top_s = std::max(lines.top_s, to_seconds(i.st_at_release));
  lines.wall_end_s = std::max(lines.wall_end_s, release_s);
  lines.marks.add(arrival_s, synchronised ? request_s : to_seconds(i.st_at_arrival));
  if (!synchronised) return;
  lines.et.add(arrival_s, request_s);
  lines.et.add(release_s, request_s);
  lines.et.add(release_s, reply_s);
  lines.top_s = std::max(lines.top_s, reply_s);
}

Lines lines_of(const std::vector<const record::Interaction*>& interactions, bool synchronised) {
  Lines lines;
  const WallTime zero = interactions.front()->wall_at_arrival;
  for (const auto* interaction : interactions)
    add_interaction(lines, *interaction, zero, synchronised);
  const double from_s = to_seconds(interactions.front()->st_at_arrival);
  lines.real_time.add(0.0, from_s);
  lines.real_time.add(lines.wall_end_s, from_s + lines.wall_end_s);
  return lines;
}

// Lag.

// The least and the largest value of each of `kBuckets` spans, so that all peaks are kept.
DataBlock lag_block(const std::vector<const record::Interaction*>& all) {
  DataBlock block("lag");
  const std::size_t per_bucket = std::max<std::size_t>(1, (all.size() + kBuckets - 1) / kBuckets);
  const auto less = [](const auto* a, const auto* b) { return a->lag < b->lag; };
  const auto add = [&](const record::Interaction* i) {
    block.add(to_seconds(i->st_at_arrival), 1e3 * to_seconds(i->lag));
  };
  for (std::size_t from = 0; from < all.size(); from += per_bucket) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(from);
    const auto end =
        all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), from + per_bucket));
    auto [least, largest] = std::minmax_element(begin, end, less);
    if (largest < least) std::swap(least, largest);
    add(*least);
    if (largest != least) add(*largest);
  }
  return block;
}

}  // namespace

std::optional<Plot> timeline_plot(const PlottedRun& run, Extent extent) {
  const auto interactions = chosen(run, extent);
  if (interactions.size() < 2) return std::nullopt;
  const bool synchronised = is_synchronised(run);
  const Lines lines = lines_of(interactions, synchronised);
  const bool first = extent == Extent::kFirstInteractions;
  Drawing drawing;
  drawing.add(lines.real_time, "with lines linewidth 1 dashtype '.'", Ink::kForeground,
              "real time");
  drawing.add(lines.st, "with lines linewidth 1.6", Ink::kForeground, "ST, simulated time");
  drawing.add(lines.et, "with lines linewidth 1.8 dashtype '-'", series_ink(run.series),
              "ET, execution time");
  drawing.add(lines.marks,
              fmt::format("with points pointtype 6 pointsize {} linewidth 1.2", first ? 0.8 : 0.3),
              series_ink(run.series), "interactions");
  const double from_s = to_seconds(interactions.front()->st_at_arrival);
  const double margin_s = std::max(1e-6, 0.04 * (lines.top_s - from_s));
  return Plot{frame_script({.height_px = first ? 340 : 300,
                            .x_label = "Wall time since the first interaction (s)",
                            .y_label = synchronised ? "ST and ET (s)" : "ST (s)"}) +
                  range_script("x", 0.0, std::max(1e-6, 1.02 * lines.wall_end_s)) +
                  range_script("y", std::max(0.0, from_s - margin_s), lines.top_s + margin_s) +
                  drawing.script(),
              fmt::format("{} against wall time, {}, {}",
                          synchronised ? "Simulated and execution time" : "Simulated time",
                          first ? "first interactions" : "whole run", run.label)};
}

std::optional<Plot> lag_plot(const PlottedRun& run) {
  const auto interactions = interactions_of(run);
  if (!is_synchronised(run) || interactions.size() < 2) return std::nullopt;
  Drawing drawing;
  drawing.add(lag_block(interactions), "with points pointtype 7 pointsize 0.3",
              series_ink(run.series), run.label);
  return Plot{frame_script({.x_label = "ST when the request arrived (s)",
                            .y_label = "Lag ε = ET − ST (ms)"}) +
                  fmt::format("set xzeroaxis linecolor {} linewidth 1\n",
                              gnuplot_colour(Ink::kForeground)) +
                  "set offsets graph 0, graph 0, graph 0.06, graph 0.06\n" + drawing.script(),
              fmt::format("Lag over simulated time, {}", run.label)};
}

}  // namespace tether::report
