
#include "tables/paper_figures.h"

#include <algorithm>
#include <array>

namespace tether::report {
namespace {

constexpr std::string_view kHost = "host";
constexpr std::string_view kTarget = "target";
constexpr std::string_view kNoSync = "target, no sync";
constexpr std::string_view kHostNoSync = "host, no sync";
constexpr std::string_view kRealSensor = "target, real sensor";

constexpr std::string_view kRange = "range_acquisition_time";
constexpr std::string_view kCamera = "camera_acquisition_time";

// The paper's virtual sensors had neither a delay model nor a barrier: their times are those of the
// link. Its real sensors correspond to a target with a profile of these sensors.
constexpr std::array kTableI = {
    PaperFigure{kTarget, "acquisition_time", 97.7, std::nullopt, kRange},
    PaperFigure{kTarget, "acquisition_time", 37.4, std::nullopt, kCamera},
    PaperFigure{kNoSync, "acquisition_time", 49.2, std::nullopt, kRange},
    PaperFigure{kNoSync, "acquisition_time", 251.0, std::nullopt, kCamera},
    PaperFigure{kHostNoSync, "acquisition_time", 44.1, std::nullopt, kRange},
    PaperFigure{kHostNoSync, "acquisition_time", 56.1, std::nullopt, kCamera},
};

constexpr std::array kTableII = {
    PaperFigure{kRealSensor, "bearing_error", 0.285, std::nullopt},
    PaperFigure{kRealSensor, "distance_error", 0.083, std::nullopt},
    PaperFigure{kRealSensor, "time_required", 0.558, std::nullopt},
    PaperFigure{kTarget, "bearing_error", 0.158, std::nullopt},
    PaperFigure{kTarget, "distance_error", 0.112, std::nullopt},
    PaperFigure{kTarget, "time_required", 0.644, std::nullopt},
    PaperFigure{kHost, "bearing_error", 0.269, std::nullopt},
    PaperFigure{kHost, "distance_error", 0.071, std::nullopt},
    PaperFigure{kHost, "time_required", 0.513, std::nullopt},
};

constexpr std::array kTableIII = {
    PaperFigure{kHost, "oscillations", 0.0, 0.0},
    PaperFigure{kHost, "time_required", 2.480, 0.033},
    PaperFigure{kTarget, "oscillations", 1.0, 1.612},
    PaperFigure{kTarget, "time_required", 9.242, 13.767},
    PaperFigure{kNoSync, "oscillations", 0.0, 0.0},
    PaperFigure{kNoSync, "time_required", 2.504, 0.108},
};

constexpr std::array kTableIV = {
    PaperFigure{kHost, "abeam_error", 0.027, 0.0187},
    PaperFigure{kHost, "time_required", 59.689, 0.800},
    PaperFigure{kTarget, "abeam_error", 0.106, 0.0440},
    PaperFigure{kTarget, "time_required", 58.484, 0.517},
    PaperFigure{kNoSync, "abeam_error", 0.046, 0.0454},
    PaperFigure{kNoSync, "time_required", 59.014, 0.960},
};

constexpr std::array kTableV = {
    PaperFigure{kHost, "return_error", 0.320, 0.256},
    PaperFigure{kHost, "estimate_error", 0.218, 0.131},
    PaperFigure{kHost, "time_required", 27.816, 1.242},
    PaperFigure{kTarget, "return_error", 0.359, 0.301},
    PaperFigure{kTarget, "estimate_error", 0.211, 0.195},
    PaperFigure{kTarget, "time_required", 27.121, 1.815},
    PaperFigure{kNoSync, "return_error", 0.328, 0.262},
    PaperFigure{kNoSync, "estimate_error", 0.245, 0.122},
    PaperFigure{kNoSync, "time_required", 26.899, 1.596},
};

constexpr std::array kTables = {
    PaperTable{
        "I", "Sensor characterization results",
        "Table I, Section IV; means of ten experiments, no spread published; target: its real "
        "sensors, no sync: its virtual ones",
        kTableI},
    PaperTable{"II", "Performance of the \"relative position\" task",
               "Table II, Section IV; means of ten experiments, no spread published", kTableII},
    PaperTable{"III", "Performance of the \"face anchor\" task",
               "Table III, Section V; ten experiments per condition", kTableIII},
    PaperTable{"IV", "Performance of the \"move forward\" task",
               "Table IV, Section V; ten experiments per condition", kTableIV},
    PaperTable{"V", "Performance of the \"closed path\" task",
               "Table V, Section V; ten experiments per condition", kTableV},
};

bool is_of(const PaperFigure& figure, std::string_view metric_kind, std::string_view metric_name) {
  return figure.metric_kind == metric_kind &&
         (figure.metric_name.empty() || figure.metric_name == metric_name);
}

}  // namespace

std::string_view without_clock(std::string_view condition) {
  constexpr std::string_view kCounted = ", counted";
  if (condition.ends_with(kCounted)) condition.remove_suffix(kCounted.size());
  return condition;
}

const PaperFigure* PaperTable::find(std::string_view condition, std::string_view metric_kind,
                                    std::string_view metric_name) const {
  const auto found = std::ranges::find_if(figures, [&](const PaperFigure& figure) {
    return figure.condition == without_clock(condition) && is_of(figure, metric_kind, metric_name);
  });
  return found != figures.end() ? &*found : nullptr;
}

bool PaperTable::has_metric(std::string_view metric_kind, std::string_view metric_name) const {
  return std::ranges::any_of(
      figures, [&](const PaperFigure& figure) { return is_of(figure, metric_kind, metric_name); });
}

std::vector<std::string_view> PaperTable::conditions() const {
  std::vector<std::string_view> names;
  for (const PaperFigure& figure : figures) {
    if (std::ranges::find(names, figure.condition) == names.end())
      names.push_back(figure.condition);
  }
  return names;
}

const PaperTable* find_paper_table(std::string_view number) {
  const auto* table = std::ranges::find(kTables, number, &PaperTable::number);
  return table != kTables.end() ? table : nullptr;
}

}  // namespace tether::report
