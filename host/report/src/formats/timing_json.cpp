#include <algorithm>

#include <nlohmann/json.hpp>

#include <tether/report/report.h>

namespace tether::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 1;

Json source_json(const timing::Timing& timing) {
  return {{"scenario", timing.scenario},      {"condition", timing.condition},
          {"program", timing.program},        {"build_id", timing.build_id},
          {"target", timing.board},           {"clock", timing.clock},
          {"recorded_at", timing.recorded_at}};
}

}  // namespace

std::string timing_json(const timing::Timing& timing) {
  Json json = {{"schema", kSchemaVersion}};
  json.update(source_json(timing));
  json["stages"] = Json::array();
  const auto rows = timing::stage_rows(timing);
  for (const timing::StageRow& row : rows)
    json["stages"].push_back({{"stage", row.stage},
                              {"count", row.count},
                              {"median_s", row.median_s},
                              {"p95_s", row.p95_s},
                              {"p99_s", row.p99_s},
                              {"worst_s", row.worst_s},
                              {"share", row.share}});
  json["warnings"] = timing::warnings(rows);
  return json.dump(2) + "\n";
}

std::string change_json(const timing::Timing& now, const timing::Timing& before,
                        const timing::Comparison& comparison, std::optional<double> limit) {
  Json json = {{"schema", kSchemaVersion},
               {"now", source_json(now)},
               {"before", source_json(before)},
               {"limit", limit ? Json(*limit) : Json(nullptr)},
               {"is_beyond_limit", limit && timing::is_beyond(comparison, *limit)},
               {"stages", Json::array()},
               {"added", comparison.added},
               {"removed", comparison.removed},
               {"doubt", comparison.doubt}};
  for (const timing::StageChange& stage : comparison.stages)
    json["stages"].push_back({{"stage", stage.stage},
                              {"change", stage.change},
                              {"low", stage.low},
                              {"high", stage.high},
                              {"has_few_samples", stage.few > 0},
                              {"is_beyond_limit", limit && stage.change > *limit}});
  return json.dump(2) + "\n";
}

}  // namespace tether::report
