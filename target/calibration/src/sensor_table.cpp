#include <algorithm>
#include <utility>

#include <tether/base/text.h>
#include <tether/calibration/characterize.h>
#include <tether/stats/sample_statistics.h>

namespace tether::calibration {
namespace {

using stats::mean;
using stats::quantile;
using stats::sample_stddev;
using Row = std::vector<std::string>;

std::vector<double> in_seconds(const std::vector<Duration>& times) {
  std::vector<double> times_s;
  for (const Duration time : times) times_s.push_back(to_seconds(time));
  return times_s;
}

double mean_s(const std::vector<tasks::Acquisition>& experiment) {
  std::vector<double> taken_s;
  for (const tasks::Acquisition& acquisition : experiment) {
    taken_s.push_back(to_seconds(acquisition.had_at - acquisition.asked_at));
  }
  return mean(taken_s);
}

/// One of the paper's rows: its means, and "-" for a kind that it does not have.
struct PaperRow {
  const char* data;
  const char* location;
  const char* range_s;
  const char* camera_s;
};
constexpr PaperRow kPaper[] = {{"real sensor", "target", "0.0977", "0.0374"},
                               {"virtual", "target", "0.0492", "0.2510"},
                               {"virtual", "host", "0.0441", "0.0561"}};

Row cells_of(const PaperRow& paper, const std::vector<SensorTimes>& sensors) {
  Row row = {std::string("  ") + paper.data, paper.location};
  for (const SensorTimes& sensor : sensors) {
    const bool is_range = sensor.kind == uav::SensorKind::kRange;
    const bool is_camera = sensor.kind == uav::SensorKind::kCamera;
    row.push_back(is_range ? paper.range_s : is_camera ? paper.camera_s : "-");
  }
  return row;
}

std::string in_ms(double seconds) {
  return fixed(seconds * 1e3, 3);
}
std::string in_ms(const std::optional<double>& seconds) {
  return seconds ? in_ms(*seconds) : "-";
}

Row distribution_row(const NamedTimes& row) {
  const TimeSummary of = summarize(row.times);
  return {row.name,           std::to_string(of.n), in_ms(of.mean_s),
          in_ms(of.stddev_s), in_ms(of.min_s),      in_ms(of.median_s),
          in_ms(of.p95_s),    in_ms(of.p99_s),      in_ms(of.max_s)};
}

}  // namespace

TimeSummary summarize(std::vector<Duration> times) {
  std::sort(times.begin(), times.end());
  const std::vector<double> sorted_s = in_seconds(times);
  return {.n = sorted_s.size(),
          .mean_s = mean(sorted_s),
          .stddev_s = sample_stddev(sorted_s),
          .min_s = sorted_s.front(),
          .median_s = quantile(sorted_s, 0.5),
          .p95_s = quantile(sorted_s, 0.95),
          .p99_s = quantile(sorted_s, 0.99),
          .max_s = sorted_s.back()};
}

std::optional<double> stddev_between_experiments_s(const SensorTimes& times) {
  std::vector<double> means_s;
  for (const auto& experiment : times.experiments) means_s.push_back(mean_s(experiment));
  return sample_stddev(means_s);
}

std::string table_1(const Origin& origin, const std::vector<SensorTimes>& sensors) {
  Row head = {"data origin", "SUT location"};
  Row measured = {origin.data, origin.location};
  for (const SensorTimes& sensor : sensors) {
    head.push_back(sensor.sensor);
    measured.push_back(fixed(summarize(sensor.taken()).mean_s, 4));
  }
  std::vector<Row> rows = {head, measured, {"paper:"}};
  for (const PaperRow& paper : kPaper) rows.push_back(cells_of(paper, sensors));
  return "Table I: mean time to acquire a sensor's data [s]\n" + text_table(rows) +
         "(paper, Table I: means of ten experiments, spread not published)\n";
}

std::string distribution_table(const std::vector<NamedTimes>& rows) {
  std::vector<Row> cells = {{"[ms]", "n", "mean", "sd", "min", "median", "p95", "p99", "max"}};
  const bool has_means = std::any_of(rows.begin(), rows.end(), [](const NamedTimes& row) {
    return row.stddev_between_experiments_s.has_value();
  });
  for (const NamedTimes& row : rows) {
    cells.push_back(distribution_row(row));
    if (has_means) cells.back().push_back(in_ms(row.stddev_between_experiments_s));
  }
  if (has_means) cells.front().push_back("sd of experiments' means");
  return text_table(cells);
}

}  // namespace tether::calibration
