#include "commands/commands.h"
#include "options/common_options.h"
#include "reading/file_kind.h"
#include "records/output_folder.h"
#include "terminal/say.h"

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/record/reader.h>
#include <tether/report/plots.h>

namespace tether::app {

namespace {

struct PlotOptions {
  std::filesystem::path record;
  std::filesystem::path out;
};

using NamedPlot = std::pair<std::string, report::Plot>;

std::vector<report::PlottedRun> runs_of(const record::Record& record) {
  std::vector<report::PlottedRun> runs;
  std::set<std::string> seen;
  for (const record::SutInfo& sut : record.header.suts) {
    if (!seen.insert(sut.uav).second) continue;
    const std::string& condition = record.header.condition;
    const bool alone = record.header.suts.size() == 1;
    runs.push_back({&record, sut.uav, alone ? condition : condition + ", " + sut.uav, runs.size()});
  }
  return runs;
}

std::vector<NamedPlot> plots_of(const record::Record& record) {
  std::vector<NamedPlot> plots;
  const auto add = [&](const std::string& name, std::optional<report::Plot> plot) {
    if (plot) plots.emplace_back(name + ".svg", std::move(*plot));
  };
  const std::vector<report::PlottedRun> runs = runs_of(record);
  for (const report::PlottedRun& run : runs) {
    const std::string suffix = runs.size() == 1 ? "" : "-" + os::file_name_of(run.uav);
    add("timeline" + suffix, timeline_plot(run, report::Extent::kWhole));
    add("timeline_zoom" + suffix, timeline_plot(run, report::Extent::kFirstInteractions));
    add("lag" + suffix, lag_plot(run));
    add("motion" + suffix, motion_plot(run));
  }
  add("path", report::path_plot(runs));
  return plots;
}

/// Draws ST and ET over wall time, the lag, height and speed, and the path.
int draw_plots(const PlotOptions& options, const std::stop_token&) {
  require_kind(options.record, FileKind::kRecord);
  const record::Record record = record::read_record(options.record);
  if (!record.damage.empty())
    say("tether: {}: plotted up to the damage: {}\n", options.record.string(),
        record::describe_damage(record));
  // Draws all of them before the first is written.
  std::vector<std::pair<std::string, std::string>> drawings;
  for (const auto& [name, plot] : plots_of(record)) drawings.emplace_back(name, draw_svg(plot));
  if (drawings.empty())
    throw Error(ErrorCode::kBadFile, {options.record.string()},
                "nothing to plot: the record has neither interactions nor ground truth");
  std::set<std::string> names;
  for (const auto& [name, svg] : drawings) names.insert(name);
  const auto out =
      make_output_folder(options.out, options.record, "plots", names, "@(timeline*|lag*|path).svg");
  for (const auto& [name, svg] : drawings) {
    os::write_file_atomically(out / name, svg);
    fmt::print("{}\n", (out / name).string());
  }
  return 0;
}

Options plot_rows(PlotOptions& o) {
  return {record_argument(o.record),
          {"--out FOLDER", "Folder for the plots [plots, next to the record]", &o.out}};
}

}  // namespace

Command plot_command() {
  return make_command(
      "plot", "Plot ST and ET over wall time, the lag, the motion and the path of a run (SVG)",
      plot_rows,
      R"(Writes timeline.svg (the whole run), timeline_zoom.svg (its first interactions), motion.svg
(height and speed), lag.svg (only for synchronised runs) and path.svg. Needs gnuplot.

Example:
  tether plot out/one/record.mcap)",
      draw_plots);
}

}  // namespace tether::app
