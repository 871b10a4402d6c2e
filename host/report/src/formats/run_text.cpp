#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/report/report.h>
#include <tether/report/verdict.h>

// The summary of a run: labels and texts, aligned in two columns.
namespace tether::report {
namespace {

/// The lines below the outcome: a label and a text.
using Rows = std::vector<std::pair<std::string, std::string>>;

std::string aligned(const Rows& rows) {
  std::string lines;
  std::size_t width = 0;
  for (const auto& [label, text] : rows) width = std::max(width, label.size());
  for (const auto& [label, text] : rows) lines += fmt::format("  {:<{}}  {}\n", label, width, text);
  return lines;
}

std::string metric_text(const campaign::MetricValue& metric, const std::string& reason) {
  const std::string unit = metric.unit == "1" ? "" : " " + metric.unit;
  const std::optional<double>& limit = metric.max ? metric.max : metric.min;
  const double value = metric.value.value_or(limit.value_or(0.0));
  const std::string text = metric.value ? distinct_text(value, limit.value_or(value), 4) + unit
                           : metric.missing_because == reason ? "none"
                                                              : "none: " + metric.missing_because;
  if (!limit) return text;
  return fmt::format("{}  ({} {})", text, metric.max ? "limit" : "at least",
                     distinct_text(*limit, value, 4));
}

std::string contacts_text(const campaign::UavContacts& own) {
  std::string text = own.count ? fmt::format("{} contact{}", *own.count, *own.count == 1 ? "" : "s")
                               : "contacts not reported";
  if (const auto& hardest = own.hardest)
    text += fmt::format(", the hardest with '{}' at ST {:.6g} s and {:.3g} m/s", hardest->with,
                        to_seconds(hardest->at), hardest->speed_m_s);
  if (const auto& nearest = own.nearest)
    text += fmt::format("; least clearance {:.3g} m, to '{}' at ST {:.6g} s", nearest->min_m,
                        nearest->to, to_seconds(nearest->at));
  return text;
}

std::string energy_text(const campaign::UavEnergy& energy) {
  std::string causes;
  for (std::size_t i = 0; i < energy::kCauses; ++i)
    causes += fmt::format("{}{} {:.4g} J", i == 0 ? "" : ", ",
                          energy::name(static_cast<energy::Cause>(i)), energy.spent_J[i]);
  return fmt::format("{:.5g} J: {}", campaign::total_J(energy.spent_J), causes);
}

std::string charge_text(const campaign::UavEnergy& energy) {
  const auto more = energy.more_flights();
  return fmt::format("{:.1f} % left of {:.1f} %{}; at least {:.4g} V", 100.0 * energy.charge_to,
                     100.0 * energy.charge_from,
                     more ? fmt::format(", enough for {:.1f} more such flights", *more) : "",
                     energy.least_voltage_V);
}

std::string clause_text(const judge::ClauseVerdict& clause) {
  const std::string margin =
      clause.margin ? fmt::format(", margin {:.4g} {}", *clause.margin, clause.unit) : "";
  return fmt::format("{}{}{}{}", clause.met ? "met" : "MISSED", margin,
                     clause.decided_at
                         ? fmt::format(", decided at ST {:.3f} s", to_seconds(*clause.decided_at))
                         : "",
                     clause.limited_by.empty() ? "" : "; " + clause.limited_by);
}

/// How the run was flown: simulator, clock, machine, sensors.
void add_circumstances(Rows& rows, const campaign::TrialResult& result) {
  rows.emplace_back("simulated",
                    fmt::format("{:.3f} s in {:.3f} s of wall time, {} interactions",
                                to_seconds(result.sync.st_at_end), to_seconds(result.this_run.wall),
                                result.sync.interactions));
  if (result.clock.kind == computer::ClockKind::kUnstamped)
    rows.emplace_back("clock",
                      "unstamped: the coordinator measured the SUT's time, which includes the "
                      "link's");
  if (!result.emulator.program.empty())
    rows.emplace_back("clock", fmt::format("counted by {}, CPU model {}", result.emulator.program,
                                           result.emulator.cpu_model));
  if (result.replay) rows.emplace_back("time", campaign::describe_replay(result));
  if (!result.target.empty()) rows.emplace_back("target", result.target);
  if (const auto& stops = result.sync.stops)
    rows.emplace_back("stops of all threads",
                      fmt::format("{}, at most {:.3f} ms late", stops->count,
                                  1e3 * to_seconds(stops->largest_overshoot)));
  if (!result.profiles.empty())
    rows.emplace_back("profiles", fmt::format("{}", fmt::join(result.profiles, ", ")));
  if (const auto simulator = result.versions.find("simulator"); simulator != result.versions.end())
    rows.emplace_back("simulator", simulator->second);
  for (const Warning& warning : result.warnings)
    if (warning.consequence == Consequence::kMissing) rows.emplace_back("missing", warning.subject);
}

void add_files(Rows& rows, const campaign::TrialResult& result,
               const std::filesystem::path& folder) {
  const std::filesystem::path record = folder / "record.mcap";
  if (std::filesystem::exists(record)) {
    rows.emplace_back("record", record.string());
    rows.emplace_back(
        "page", fmt::format("tether report {} --format html", os::shell_word(folder.string())));
  }
  if (result.outcome == campaign::Outcome::kGoalReached) return;
  // What a program printed often says why.
  for (const campaign::SutResult& sut : result.suts)
    if (const auto log = folder / ("sut-" + sut.uav + ".log"); std::filesystem::exists(log))
      rows.emplace_back("output", log.string());
}

Rows rows_of(const campaign::TrialResult& result, const std::filesystem::path& folder) {
  Rows rows;
  for (const auto& metric : result.metrics)
    rows.emplace_back(metric.label, metric_text(metric, result.reason));
  for (const auto& clause : result.clauses) rows.emplace_back(clause.name, clause_text(clause));
  for (const campaign::UavEnergy& energy : result.energy) {
    rows.emplace_back("energy of " + energy.uav, energy_text(energy));
    rows.emplace_back("charge of " + energy.uav, charge_text(energy));
  }
  for (const campaign::UavContacts& own : result.contacts)
    rows.emplace_back(own.uav, contacts_text(own));
  add_circumstances(rows, result);
  if (result.audit) rows.emplace_back("audit", result.audit->summary);
  for (const std::string& note : result.this_run.notes) rows.emplace_back("note", note);
  add_files(rows, result, folder);
  return rows;
}

Rows rows_of_failure(const campaign::TrialResult& result, const std::filesystem::path& folder) {
  Rows rows;
  if (result.sync.interactions > 0)
    rows.emplace_back("ended",
                      fmt::format("at ST {:.3f} s, after {} interactions",
                                  to_seconds(result.sync.st_at_end), result.sync.interactions));
  for (const std::string& note : result.this_run.notes) rows.emplace_back("note", note);
  add_files(rows, result, folder);
  return rows;
}

}  // namespace

std::string run_text(const campaign::TrialResult& result, const std::filesystem::path& folder,
                     Markup markup) {
  const bool has_failed = result.outcome == campaign::Outcome::kFailed;  // its reason is an error
  const std::string head =
      verdict_text(verdicts_of(results_of_run(result)), markup) +
      fmt::format("{} under \"{}\", seed {}: {}{}\n", result.scenario, result.condition,
                  result.seed, campaign::name(result.outcome),
                  has_failed ? "" : ": " + result.reason);
  // Of a flight that failed, no value means anything.
  return head + aligned(has_failed ? rows_of_failure(result, folder) : rows_of(result, folder));
}

}  // namespace tether::report
