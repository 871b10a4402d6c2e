#include "this_run_json.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

namespace tether::campaign {
namespace {

constexpr std::array<std::string_view, 6> kDoubts = {"unseen_wait", "parallel_threads",
                                                     "disk_wait",   "stretched_wait",
                                                     "slight_wait", "busy_machine"};

Json json_of(const TargetReport& target) {
  return Json{{"name", target.name},         {"address", target.address},
              {"before", target.before},     {"after", target.after},
              {"warnings", target.warnings}, {"is_spoiled", target.is_spoiled}};
}

Json json_of(const Doubt& doubt) {
  return Json{{"kind", name(doubt.kind)}, {"subject", doubt.subject}, {"amount", doubt.amount}};
}

Doubt read_doubt(const JsonReader& json) {
  const std::string word = json.text("kind");
  const auto found = std::ranges::find(kDoubts, word);
  if (found == kDoubts.end()) json.fail("kind", fmt::format("is \"{}\"", word));
  return {static_cast<Doubt::Kind>(found - kDoubts.begin()), json.text("subject"),
          json.number("amount")};
}

Json json_of(const Sizing& sizing) {
  Json json{{"scenario", sizing.scenario}, {"condition", sizing.condition}};
  if (!sizing.target.empty()) json["target"] = sizing.target;
  if (sizing.between) {
    json["least"] = sizing.between->first;
    json["most"] = sizing.between->second;
  }
  return json;
}

Sizing read_sizing(const JsonReader& json) {
  Sizing sizing{.scenario = json.text("scenario"), .condition = json.text("condition")};
  if (json.has("target")) sizing.target = json.text("target");
  if (json.has("least")) sizing.between = {json.number("least"), json.number("most")};
  return sizing;
}

Json json_of(const MachineLoad& load) {
  return Json{
      {"machine", load.machine}, {"block_spread", load.block_spread}, {"others", load.others}};
}

MachineLoad read_load(const JsonReader& json) {
  return {json.text("machine"), json.number("block_spread"), json.number("others")};
}

TargetReport read_target(const JsonReader& json) {
  return {.name = json.text("name"),
          .address = json.text("address"),
          .before = json.object("before").all_texts(),
          .after = json.object("after").all_texts(),
          .warnings = json.texts("warnings"),
          .is_spoiled = json.boolean("is_spoiled")};
}

SimulatorFigures read_simulator(const JsonReader& json) {
  return {.stepping = json.seconds("stepping_s"),
          .drawing = json.seconds("drawing_s"),
          .pictures = json.count("pictures"),
          .drawn_ahead = json.count("drawn_ahead"),
          .drawn_in_vain = json.count("drawn_in_vain")};
}

}  // namespace

std::string_view name(Doubt::Kind kind) {
  return kDoubts[static_cast<std::size_t>(kind)];
}

Json json_of(const ThisRun& run) {
  Json json{{"started_at", run.started_at},
            {"machine", run.machine},
            {"wall_s", exact_seconds(run.wall)},
            {"largest_lag_s", exact_seconds(run.largest_lag)},
            {"attempts", run.attempts}};
  if (!run.first_failure.empty()) json["first_failure"] = run.first_failure;
  if (run.target) json["target"] = json_of(*run.target);
  for (const TargetReport& target : run.more_targets)
    json["more_targets"].push_back(json_of(target));
  if (!run.notes.empty()) json["notes"] = run.notes;
  for (const Doubt& doubt : run.doubts) json["doubts"].push_back(json_of(doubt));
  for (const MachineLoad& load : run.loads) json["loads"].push_back(json_of(load));
  if (!run.sut_files.empty()) json["sut_files"] = run.sut_files;
  if (run.sizing) json["sizing"] = json_of(*run.sizing);
  if (run.simulator)
    json["simulator"] = Json{{"stepping_s", exact_seconds(run.simulator->stepping)},
                             {"drawing_s", exact_seconds(run.simulator->drawing)},
                             {"pictures", run.simulator->pictures},
                             {"drawn_ahead", run.simulator->drawn_ahead},
                             {"drawn_in_vain", run.simulator->drawn_in_vain}};
  return json;
}

ThisRun read_this_run(const JsonReader& json) {
  ThisRun run;
  run.started_at = json.text("started_at");
  run.machine = json.text("machine");
  run.wall = json.seconds("wall_s");
  run.largest_lag = json.seconds("largest_lag_s");
  const std::uint64_t attempts = json.count("attempts");
  if (attempts < 1 || attempts > 1000) json.fail("attempts", "must be 1 to 1000");
  run.attempts = static_cast<int>(attempts);
  if (json.has("first_failure")) run.first_failure = json.text("first_failure");
  if (json.has("target")) run.target = read_target(json.object("target"));
  if (json.has("more_targets"))
    for (const JsonReader& target : json.objects("more_targets"))
      run.more_targets.push_back(read_target(target));
  if (json.has("notes")) run.notes = json.texts("notes");
  if (json.has("doubts"))
    for (const JsonReader& doubt : json.objects("doubts")) run.doubts.push_back(read_doubt(doubt));
  if (json.has("loads"))
    for (const JsonReader& load : json.objects("loads")) run.loads.push_back(read_load(load));
  if (json.has("sut_files")) run.sut_files = json.texts("sut_files");
  if (json.has("sizing")) run.sizing = read_sizing(json.object("sizing"));
  if (json.has("simulator")) run.simulator = read_simulator(json.object("simulator"));
  return run;
}

}  // namespace tether::campaign
