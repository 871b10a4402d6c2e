#include "fields.h"
#include "pace_fields.h"

#include <array>

#include <nlohmann/json.hpp>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/campaign/result.h>
#include <tether/os/text_file.h>

// `result.json`: the members of each part of a result, from the smallest to the whole.
namespace tether::campaign {
namespace {

constexpr std::array<std::string_view, 3> kOutcomes = {"goal_reached", "goal_missed", "failed"};

// A SUT's details are an object that the SUT defines. What is not an object, or is nested too
// deeply to be read again, is kept as text.
Json json_of_details(const std::string& details) {
  if (details.empty()) return nullptr;
  const bool is_deep = json_depth(details) > kMaxSutJsonDepth;
  Json parsed = is_deep ? Json() : Json::parse(details, nullptr, false);
  return parsed.is_object() ? parsed : Json(details);
}

std::string details_of(const Json& json) {
  if (json.is_null()) return "";
  return json.is_string() ? json.get<std::string>() : json.dump();
}

}  // namespace

// Of a flight.

void fields(auto& io, Maybe<MetricValue> auto& m) {
  io("name", m.name);
  io("kind", m.kind);
  io("label", m.label);
  io("unit", m.unit);
  io("value", m.value);
  io("max", m.max);
  io.derived("met", m.is_met());
  io.optional("min", m.min);
  if (!m.value) io("missing_because", m.missing_because);
}

void fields(auto& io, Maybe<scenario::Varied> auto& m) {
  io("name", m.name);
  io("what", m.what);
  io("value", m.value);
}

void fields(auto& io, Maybe<ReplayReport> auto& m) {
  fields(io, m.from);
  io("unknown_stages", m.unknown_stages);
}

void fields(auto& io, Maybe<judge::TaskSpan> auto& m) {
  io("uav", m.uav);
  io("task", m.task);
  io("from_s", m.from);
  io("to_s", m.to);
  io("status", m.status);
  io("reason", m.reason);
}

void fields(auto& io, Maybe<judge::MarginAt> auto& m) {
  io("at_s", m.at);
  io("margin", m.margin);
}

void fields(auto& io, Maybe<judge::ClauseVerdict> auto& m) {
  io("uav", m.uav);
  io("name", m.name);
  io("met", m.met);
  io("margin", m.margin);
  io("unit", m.unit);
  io.optional("from_s", m.from);
  io.optional("to_s", m.to);
  io.optional("deadline_s", m.deadline);
  io.optional("decided_at_s", m.decided_at);
  io("limited_by", m.limited_by);
  io.some("margins", m.margins);
  io.some("quantiles", m.quantiles);
  io.some("quantity", m.quantity);
  io.some("sensor", m.sensor);
  io.optional("limit", m.limit);
  io.optional("least_without_computing", m.least_without_computing);
  io.optional("median_of_computing", m.median_of_computing);
}

void fields(auto& io, Maybe<SutResult> auto& m) {
  io("uav", m.uav);
  io("sut", m.sut);
  if (io.has("as_is", m.as_is)) io("as_is", m.as_is);
  fields(io, m.clock);
  io("et_at_end_s", m.et_at_end);
  io("finished", m.finished);
  io("reached_goal", m.reached_goal);
  io("outcome", m.outcome);
  io.converted("details", m.details, json_of_details, details_of);
}

void fields(auto& io, Maybe<UavContacts> auto& m) {
  io("uav", m.uav);
  io.reported("contacts", m.count);
  if (m.count)
    io("hard", m.hard);
  else
    io.derived("hard", kNotReported);
  if (io.has("hardest", m.hardest.has_value())) {
    auto& hardest = io.value_of(m.hardest);
    io.implied(hardest.uav, m.uav);
    io.object("hardest", [&](auto& inner) {
      inner("at_s", hardest.at);
      inner("with", hardest.with);
      inner("speed_m_s", hardest.speed_m_s);
    });
  }
  if (!io.has("nearest", m.nearest.has_value())) return io.derived("min_clearance_m", kNotReported);
  auto& nearest = io.value_of(m.nearest);
  io.implied(nearest.uav, m.uav);
  io("min_clearance_m", nearest.min_m);
  io.object("nearest", [&](auto& inner) {
    inner("at_s", nearest.at);
    inner("to", nearest.to);
  });
}

/// Of UavEnergy or one of its tasks.
void spent_fields(auto& io, auto& spent_J) {
  io.derived("total_j", total_J(spent_J));
  io.object("spent_j", [&](auto& by_cause) {
    for (std::size_t i = 0; i < energy::kCauses; ++i)
      by_cause(name(static_cast<energy::Cause>(i)), spent_J[i]);
  });
}

void fields(auto& io, Maybe<UavEnergy::OfTask> auto& m) {
  io("task", m.task);
  spent_fields(io, m.spent_J);
}

void fields(auto& io, Maybe<UavEnergy> auto& m) {
  io("uav", m.uav);
  spent_fields(io, m.spent_J);
  io("charge_from", m.charge_from);
  io("charge_to", m.charge_to);
  io.derived("more_flights", m.more_flights());
  io("least_voltage_v", m.least_voltage_V);
  if (io.has("cut_off_at_s", m.cut_off_at != SimTime::max())) io("cut_off_at_s", m.cut_off_at);
  io("tasks", m.tasks);
}

void fields(auto& io, Maybe<SyncFigures> auto& m) {
  io("interactions", m.interactions);
  io("causality_violations", m.causality_violations);
  io("largest_grid_error_s", m.largest_grid_error);
  io("st_at_end_s", m.st_at_end);
  if (!io.has("stops", m.stops.has_value())) return;
  auto& stops = io.value_of(m.stops);
  io("stops", stops.count);
  io("largest_overshoot_s", stops.largest_overshoot);
}

void fields(auto& io, Maybe<AuditVerdict> auto& m) {
  io("passed", m.passed);
  io("summary", m.summary);
}

void fields(auto& io, Maybe<Warning> auto& m) {
  io.word("consequence", m.consequence, kConsequences.size());
  io("file", m.where.file);
  io("line", m.where.line);
  io("subject", m.subject);
  io("message", m.message);
  io.implied(m.can_change_verdict, usually_changes_verdict(m.consequence));
  io.since("can_change_verdict", m.can_change_verdict);
}

// Of one run of it.

void fields(auto& io, Maybe<TargetReport> auto& m) {
  io("name", m.name);
  io("address", m.address);
  io("before", m.before);
  io("after", m.after);
  io("warnings", m.warnings);
  io("is_spoiled", m.is_spoiled);
}

void fields(auto& io, Maybe<Doubt> auto& m) {
  io.word("kind", m.kind, timing::kDoubts);
  io("subject", m.subject);
  io("amount", m.amount);
  io.some("recorded_in", m.recorded_in);
}

void fields(auto& io, Maybe<MachineLoad> auto& m) {
  io("machine", m.machine);
  io("block_spread", m.block_spread);
  io("others", m.others);
}

void fields(auto& io, Maybe<Sizing> auto& m) {
  io("scenario", m.scenario);
  io("condition", m.condition);
  io.some("target", m.target);
  if (!io.has("least", m.between.has_value())) return;
  auto& between = io.value_of(m.between);
  io("least", between.first);
  io("most", between.second);
}

void fields(auto& io, Maybe<SimulatorFigures> auto& m) {
  io("stepping_s", m.stepping);
  io("drawing_s", m.drawing);
  io("pictures", m.pictures);
  io("drawn_ahead", m.drawn_ahead);
  io("drawn_in_vain", m.drawn_in_vain);
}

void fields(auto& io, Maybe<ThisRun> auto& m) {
  io("started_at", m.started_at);
  io("machine", m.machine);
  io("wall_s", m.wall);
  io("largest_lag_s", m.largest_lag);
  io.within("attempts", m.attempts, 1, 1000);
  io.some("first_failure", m.first_failure);
  io.optional("target", m.target);
  io.some("more_targets", m.more_targets);
  io.some("notes", m.notes);
  io.some("stopped_program", m.stopped_program);
  io.some("doubts", m.doubts);
  io.some("loads", m.loads);
  io.some("sut_files", m.sut_files);
  io.optional("sizing", m.sizing);
  io.optional("simulator", m.simulator);
}

void fields(auto& io, Maybe<TrialResult> auto& m) {
  io("scenario", m.scenario);
  io("condition", m.condition);
  io("seed", m.seed);
  io("policy", m.policy);
  fields(io, m.clock);
  if (io.has("step_s", m.step.has_value())) {
    auto& step = io.value_of(m.step);
    io("step_s", step.step);
    io("step_from", step.from);
  }
  io.some("target", m.target);
  io.some("settings", m.settings);
  io.some("varied", m.varied);
  if (io.has("emulator", !m.emulator.program.empty())) io("emulator", m.emulator);
  io.optional("replay", m.replay);
  io("real_time_factor", m.real_time_factor);
  io.since("profiles", m.profiles);
  io.word("outcome", m.outcome, kOutcomes.size());
  io.derived("exit_code", exit_code(m.outcome));
  io("end", m.end);
  io("reason", m.reason);
  io("metrics", m.metrics);
  io("suts", m.suts);
  io("sync", m.sync);
  io.since("contacts", m.contacts);
  io("audit", m.audit);
  io.some("flight_digest", m.flight_digest);
  io.some("tasks", m.tasks);
  io.some("clauses", m.clauses);
  io.some("energy", m.energy);
  io.optional("pace", m.pace);
  if (m.pace) {
    io.implied(m.pace->seed, m.seed);
    io.implied(m.pace->speed.emulator, m.emulator);
  }
  io.some("warnings", m.warnings);
  io("versions", m.versions);
  io("this_run", m.this_run);
}

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
  return text_of(result, kResultSchemaVersion);
}

TrialResult result_from_json(const std::string& text, const std::filesystem::path& file) {
  TrialResult result = read_text<TrialResult>(text, file, kResultSchemaVersion);
  if (const std::string why = contradiction_in(result); !why.empty())
    throw Error(ErrorCode::kBadFile, {file.string()},
                fmt::format("contradicts itself: the outcome is \"{}\", but {}. Was it edited? Fly "
                            "again.",
                            name(result.outcome), why))
        .about("outcome");
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
