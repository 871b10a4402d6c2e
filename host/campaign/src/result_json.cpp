#include "json_reader.h"
#include "this_run_json.h"
#include "warning_json.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/json_depth.h>
#include <tether/campaign/result.h>
#include <tether/os/text_file.h>

// `result.json`: first how each part of a result is written, then how it is read.
namespace tether::campaign {
namespace {

constexpr const char* kNotReported = "not reported";
constexpr std::array<std::string_view, 3> kOutcomes = {"goal_reached", "goal_missed", "failed"};

// To JSON.

Json optional_number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const MetricValue& metric) {
  Json json{{"name", metric.name},
            {"kind", metric.kind},
            {"label", metric.label},
            {"unit", metric.unit},
            {"value", optional_number(metric.value)},
            {"max", optional_number(metric.max)},
            {"met", metric.is_met()}};
  if (metric.min) json["min"] = *metric.min;
  if (!metric.value) json["missing_because"] = metric.missing_because;
  return json;
}

Json json_of(const ReplayReport& replay) {
  return Json{{"timing", replay.from.timing},           {"mode", replay.from.mode},
              {"recorded_at", replay.from.recorded_at}, {"board", replay.from.board},
              {"build_id", replay.from.build_id},       {"unknown_stages", replay.unknown_stages}};
}

Json json_of(const judge::TaskSpan& task) {
  return Json{{"uav", task.uav},
              {"task", task.task},
              {"from_s", exact_seconds(task.from)},
              {"to_s", exact_seconds(task.to)},
              {"status", task.status},
              {"reason", task.reason}};
}

constexpr std::array<std::pair<const char*, std::optional<SimTime> judge::ClauseVerdict::*>, 4>
    kTimesOfClauses = {{{"from_s", &judge::ClauseVerdict::from},
                        {"to_s", &judge::ClauseVerdict::to},
                        {"deadline_s", &judge::ClauseVerdict::deadline},
                        {"decided_at_s", &judge::ClauseVerdict::decided_at}}};

Json json_of(const judge::ClauseVerdict& clause) {
  Json json{{"uav", clause.uav},
            {"name", clause.name},
            {"met", clause.met},
            {"margin", optional_number(clause.margin)},
            {"unit", clause.unit}};
  for (const auto& [name, time] : kTimesOfClauses)
    if (clause.*time) json[name] = exact_seconds(*(clause.*time));
  json["limited_by"] = clause.limited_by;
  for (const auto& [at, margin] : clause.margins)
    json["margins"].push_back({{"at_s", exact_seconds(at)}, {"margin", margin}});
  if (!clause.quantiles.empty()) json["quantiles"] = clause.quantiles;
  if (clause.limit) json["limit"] = *clause.limit;
  return json;
}

// A SUT's details are an object that the SUT defines. What is not an object, or is nested too
// deeply to be read again, is kept as text.
Json json_of_details(const std::string& details) {
  if (details.empty()) return nullptr;
  const bool is_deep = json_depth(details) > kMaxSutJsonDepth;
  Json parsed = is_deep ? Json() : Json::parse(details, nullptr, false);
  return parsed.is_object() ? parsed : Json(details);
}

/// For the object of a SUT or a trial.
Json json_of(const computer::Clock& clock) {
  Json json{{"clock", computer::name(clock.kind)}, {"cpu_factor", clock.factor}};
  if (clock.kind == computer::ClockKind::kScripted)
    json["computing_s"] = exact_seconds(clock.computing);
  return json;
}

Json json_of(const SutResult& sut) {
  Json json{{"uav", sut.uav}, {"sut", sut.sut}};
  json.update(json_of(sut.clock));
  json.update(
      Json{{"et_at_end_s", sut.et_at_end ? Json(exact_seconds(*sut.et_at_end)) : Json(nullptr)},
           {"finished", sut.finished},
           {"reached_goal", sut.reached_goal},
           {"outcome", sut.outcome},
           {"details", json_of_details(sut.details)}});
  return json;
}

Json json_of(const UavContacts& own) {
  Json json{{"uav", own.uav},
            {"contacts", own.count ? Json(*own.count) : Json(kNotReported)},
            {"hard", own.count ? Json(own.hard) : Json(kNotReported)}};
  if (own.hardest)
    json["hardest"] = Json{{"at_s", exact_seconds(own.hardest->at)},
                           {"with", own.hardest->with},
                           {"speed_m_s", own.hardest->speed_m_s}};
  json["min_clearance_m"] = own.nearest ? Json(own.nearest->min_m) : Json(kNotReported);
  if (own.nearest)
    json["nearest"] = Json{{"at_s", exact_seconds(own.nearest->at)}, {"to", own.nearest->to}};
  return json;
}

Json json_of(const energy::Energies_J& spent_J) {
  Json json;
  for (std::size_t i = 0; i < energy::kCauses; ++i)
    json[std::string(name(static_cast<energy::Cause>(i)))] = spent_J[i];
  return json;
}

Json json_of(const UavEnergy& energy) {
  Json tasks = Json::array();
  for (const auto& [task, spent_J] : energy.tasks)
    tasks.push_back({{"task", task}, {"total_j", total_J(spent_J)}, {"spent_j", json_of(spent_J)}});
  return Json{{"uav", energy.uav},
              {"total_j", total_J(energy.spent_J)},
              {"spent_j", json_of(energy.spent_J)},
              {"charge_from", energy.charge_from},
              {"charge_to", energy.charge_to},
              {"more_flights", optional_number(energy.more_flights())},
              {"least_voltage_v", energy.least_voltage_V},
              {"tasks", tasks}};
}

using campaign::json_of;  // of a warning

template <class T>
Json json_of(const std::vector<T>& elements) {
  Json array = Json::array();
  for (const T& element : elements) array.push_back(json_of(element));
  return array;
}

Json json_of(const record::EmulatorInfo& emulator) {
  Json costs = Json::array();
  for (const auto& [work, ns] : emulator.costs) costs.push_back(Json{{"work", work}, {"ns", ns}});
  return Json{{"program", emulator.program}, {"cpu_model", emulator.cpu_model}, {"costs", costs}};
}

Json json_of(const SyncFigures& sync) {
  Json json{{"interactions", sync.interactions},
            {"causality_violations", sync.causality_violations},
            {"largest_grid_error_s", exact_seconds(sync.largest_grid_error)},
            {"st_at_end_s", exact_seconds(sync.st_at_end)}};
  if (sync.stops) {
    json["stops"] = sync.stops->count;
    json["largest_overshoot_s"] = exact_seconds(sync.stops->largest_overshoot);
  }
  return json;
}

Json json_of(const std::optional<AuditVerdict>& audit) {
  if (!audit) return nullptr;
  return Json{{"passed", audit->passed}, {"summary", audit->summary}};
}

// From JSON.

MetricValue read_metric(const JsonReader& json) {
  MetricValue metric;
  metric.name = json.text("name");
  metric.kind = json.text("kind");
  metric.label = json.text("label");
  metric.unit = json.text("unit");
  metric.value = json.optional_number("value");
  metric.max = json.optional_number("max");
  if (json.has("min")) metric.min = json.number("min");
  if (!metric.value) metric.missing_because = json.text("missing_because");
  return metric;
}

judge::TaskSpan read_task(const JsonReader& json) {
  return {json.text("uav"),
          json.text("task"),
          SimTime(json.seconds("from_s")),
          SimTime(json.seconds("to_s")),
          json.text("status"),
          json.text("reason")};
}

judge::ClauseVerdict read_clause(const JsonReader& json) {
  judge::ClauseVerdict clause{.uav = json.text("uav"), .name = json.text("name")};
  clause.met = json.boolean("met");
  clause.margin = json.optional_number("margin");
  clause.unit = json.text("unit");
  for (const auto& [name, time] : kTimesOfClauses)
    if (json.has(name)) clause.*time = SimTime(json.seconds(name));
  clause.limited_by = json.text("limited_by");
  if (json.has("margins"))
    for (const JsonReader& margin : json.objects("margins"))
      clause.margins.push_back({SimTime(margin.seconds("at_s")), margin.number("margin")});
  if (json.has("quantiles")) clause.quantiles = json.numbers("quantiles");
  if (json.has("limit")) clause.limit = json.number("limit");
  return clause;
}

std::string read_details(const JsonReader& json) {
  const Json& details = json.member("details");
  if (details.is_null()) return "";
  return details.is_string() ? details.get<std::string>() : details.dump();
}

computer::Clock read_clock(const JsonReader& json) {
  const auto kind = computer::clock_kind(json.text("clock"));
  if (!kind) json.fail("clock", "is unknown");
  computer::Clock clock{*kind, json.number("cpu_factor")};
  if (json.has("computing_s")) clock.computing = json.seconds("computing_s");
  return clock;
}

SutResult read_sut(const JsonReader& json) {
  SutResult sut;
  sut.uav = json.text("uav");
  sut.sut = json.text("sut");
  sut.clock = read_clock(json);
  if (!json.member("et_at_end_s").is_null()) sut.et_at_end = ExecTime(json.seconds("et_at_end_s"));
  sut.finished = json.boolean("finished");
  sut.reached_goal = json.boolean("reached_goal");
  sut.outcome = json.text("outcome");
  sut.details = read_details(json);
  return sut;
}

SyncFigures read_sync(const JsonReader& json) {
  SyncFigures sync{json.count("interactions"), json.count("causality_violations"),
                   json.seconds("largest_grid_error_s"), SimTime(json.seconds("st_at_end_s"))};
  if (json.has("stops"))
    sync.stops = StopFigures{json.count("stops"), json.seconds("largest_overshoot_s")};
  return sync;
}

UavContacts read_contacts(const JsonReader& json) {
  UavContacts own{.uav = json.text("uav")};
  if (!json.member("contacts").is_string()) {
    own.count = json.count("contacts");
    own.hard = json.count("hard");
  }
  if (json.has("hardest")) {
    const JsonReader hardest = json.object("hardest");
    own.hardest = {own.uav, SimTime(hardest.seconds("at_s")), hardest.text("with"),
                   hardest.number("speed_m_s")};
  }
  if (json.has("nearest")) {
    const JsonReader nearest = json.object("nearest");
    own.nearest = {own.uav, json.number("min_clearance_m"), SimTime(nearest.seconds("at_s")),
                   nearest.text("to")};
  }
  return own;
}

energy::Energies_J read_spent(const JsonReader& json) {
  const JsonReader by_cause = json.object("spent_j");
  energy::Energies_J spent_J{};
  for (std::size_t i = 0; i < energy::kCauses; ++i)
    spent_J[i] = by_cause.number(name(static_cast<energy::Cause>(i)));
  return spent_J;
}

UavEnergy read_energy(const JsonReader& json) {
  UavEnergy energy{.uav = json.text("uav"),
                   .spent_J = read_spent(json),
                   .charge_from = json.number("charge_from"),
                   .charge_to = json.number("charge_to"),
                   .least_voltage_V = json.number("least_voltage_v")};
  for (const JsonReader& task : json.objects("tasks"))
    energy.tasks.push_back({task.text("task"), read_spent(task)});
  return energy;
}

ReplayReport read_replay(const JsonReader& json) {
  return {{json.text("timing"), json.text("mode"), json.text("recorded_at"), json.text("board"),
           json.text("build_id")},
          json.texts("unknown_stages")};
}

Outcome read_outcome(const JsonReader& json) {
  const std::string word = json.text("outcome");
  const auto found = std::ranges::find(kOutcomes, word);
  if (found == kOutcomes.end()) json.fail("outcome", fmt::format("is \"{}\"", word));
  return static_cast<Outcome>(found - kOutcomes.begin());
}

record::EmulatorInfo read_emulator(const JsonReader& json) {
  record::EmulatorInfo emulator{json.text("program"), json.text("cpu_model"), {}};
  for (const JsonReader& cost : json.objects("costs"))
    emulator.costs.push_back({cost.text("work"), cost.number("ns")});
  return emulator;
}

void read_trial(const JsonReader& json, TrialResult& result) {
  result.scenario = json.text("scenario");
  result.condition = json.text("condition");
  result.seed = json.count("seed");
  result.policy = json.text("policy");
  result.clock = read_clock(json);
  result.real_time_factor = json.number("real_time_factor");
  if (json.has("step_s")) result.step = StepReport{json.seconds("step_s"), json.text("step_from")};
  if (json.has("target")) result.target = json.text("target");
  if (json.has("settings")) result.settings = json.object("settings").all_texts();
  if (json.has("emulator")) result.emulator = read_emulator(json.object("emulator"));
  if (json.has("replay")) result.replay = read_replay(json.object("replay"));
  if (json.has("profiles")) result.profiles = json.texts("profiles");
  result.outcome = read_outcome(json);
  result.end = json.text("end");
  result.reason = json.text("reason");
}

}  // namespace

std::string_view name(Outcome outcome) {
  return kOutcomes[static_cast<std::size_t>(outcome)];
}

int exit_code(Outcome outcome) {
  constexpr std::array kCodes = {0, 1, 3};
  return kCodes[static_cast<std::size_t>(outcome)];
}

int exit_code(const TrialResult& result) {
  return exit_code(result.has_unseen_time() ? Outcome::kFailed : result.outcome);
}

bool TrialResult::has_unseen_time() const {
  return std::ranges::any_of(this_run.doubts, &Doubt::is_of_unseen_time);
}

const MetricValue* TrialResult::find_metric(std::string_view metric) const {
  const auto found = std::ranges::find(metrics, metric, &MetricValue::name);
  return found == metrics.end() ? nullptr : &*found;
}

std::string to_json(const TrialResult& result) {
  Json json{{"schema", kResultSchemaVersion},
            {"scenario", result.scenario},
            {"condition", result.condition},
            {"seed", result.seed},
            {"policy", result.policy}};
  json.update(json_of(result.clock));
  if (result.step)
    json.update(
        Json{{"step_s", exact_seconds(result.step->step)}, {"step_from", result.step->from}});
  if (!result.target.empty()) json["target"] = result.target;
  if (!result.settings.empty()) json["settings"] = result.settings;
  if (!result.emulator.program.empty()) json["emulator"] = json_of(result.emulator);
  if (result.replay) json["replay"] = json_of(*result.replay);
  json.update(Json{{"real_time_factor", result.real_time_factor},
                   {"profiles", result.profiles},
                   {"outcome", name(result.outcome)},
                   {"exit_code", exit_code(result.outcome)},
                   {"end", result.end},
                   {"reason", result.reason},
                   {"metrics", json_of(result.metrics)},
                   {"suts", json_of(result.suts)},
                   {"sync", json_of(result.sync)},
                   {"contacts", json_of(result.contacts)},
                   {"audit", json_of(result.audit)}});
  if (!result.flight_digest.empty()) json["flight_digest"] = result.flight_digest;
  if (!result.tasks.empty()) json["tasks"] = json_of(result.tasks);
  if (!result.clauses.empty()) json["clauses"] = json_of(result.clauses);
  if (!result.energy.empty()) json["energy"] = json_of(result.energy);
  if (!result.warnings.empty()) json["warnings"] = json_of(result.warnings);
  json.update(Json{{"versions", result.versions}, {"this_run", json_of(result.this_run)}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

TrialResult result_from_json(const std::string& text, const std::filesystem::path& file) {
  const Json document = parse_json(text, file);
  const JsonReader json(document, file);
  json.require_schema(kResultSchemaVersion);
  TrialResult result;
  read_trial(json, result);
  for (const JsonReader& metric : json.objects("metrics")) {
    result.metrics.push_back(read_metric(metric));
  }
  if (json.has("tasks"))
    for (const JsonReader& task : json.objects("tasks")) result.tasks.push_back(read_task(task));
  if (json.has("clauses"))
    for (const JsonReader& clause : json.objects("clauses"))
      result.clauses.push_back(read_clause(clause));
  if (json.has("energy"))
    for (const JsonReader& energy : json.objects("energy"))
      result.energy.push_back(read_energy(energy));
  for (const JsonReader& sut : json.objects("suts")) result.suts.push_back(read_sut(sut));
  result.sync = read_sync(json.object("sync"));
  if (json.has("flight_digest")) result.flight_digest = json.text("flight_digest");
  if (json.has("contacts"))
    for (const JsonReader& own : json.objects("contacts"))
      result.contacts.push_back(read_contacts(own));
  if (!json.member("audit").is_null()) {
    const JsonReader audit = json.object("audit");
    result.audit = AuditVerdict{audit.boolean("passed"), audit.text("summary")};
  }
  if (json.has("warnings")) {
    for (const JsonReader& warning : json.objects("warnings"))
      result.warnings.push_back(read_warning(warning));
  }
  result.versions = json.object("versions").all_texts();
  result.this_run = read_this_run(json.object("this_run"));
  return result;
}

void write_result(const std::filesystem::path& folder, const TrialResult& result) {
  os::write_file_atomically(folder / kResultFile, to_json(result));
}

TrialResult read_result(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kResultFile;
  return result_from_json(os::read_file(file), file);
}

}  // namespace tether::campaign
