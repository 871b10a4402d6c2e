#include "back_ends.h"
#include "commands/commands.h"
#include "options/junit_option.h"
#include "options/simulator_option.h"
#include "options/target_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/say.h"
#include "terminal/status_line.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/result.h>
#include <tether/os/program.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/page.h>
#include <tether/report/verdict.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>
#include <tether/sim_sdf/world_store.h>

/// `tether run`: makes the specification of a trial from the options, runs it with the status on
/// stderr, and prints the result.
namespace tether::app {

namespace {

/// Moves the condition's SUTs to that target. A condition that was selected by name keeps its name,
/// so that results show both.
void move_to(scenario::Condition& condition, scenario::Target target, bool keep_name) {
  const std::string name = target.name, description = target.description;
  scenario::place_on(condition, std::move(target));
  condition.name = keep_name ? fmt::format("{} on {}", condition.name, name) : name;
  if (!keep_name) condition.description = description;
}

/// The target for a board's address; its time is measured by the wall clock.
scenario::Target board_at(const scenario::SshAddress& address) {
  scenario::Target target;
  target.name = address.destination;
  target.ssh = address;
  return target;
}

/// The file that the user means, which is not of another kind.
std::filesystem::path find_file(const scenario::ShippedFiles& shipped, scenario::ShippedKind kind,
                                const std::filesystem::path& given, FileKind wanted) {
  const std::filesystem::path file = shipped.find(kind, given);
  require_kind(file, wanted);
  return file;
}

/// The condition and the target of the options.
scenario::Condition make_condition(const scenario::Scenario& scenario, const RunOptions& options,
                                   const scenario::ShippedFiles& shipped) {
  scenario::Condition condition = pick_condition(scenario, options.condition);
  if (options.real_time_factor > 0.0) condition.real_time_factor = options.real_time_factor;
  const bool keep_name = !options.condition.empty();
  const TargetOption target = parse_target_option(options.target);
  if (const auto* file = std::get_if<std::filesystem::path>(&target))
    move_to(condition,
            scenario::load_target(
                find_file(shipped, scenario::ShippedKind::kTarget, *file, FileKind::kTarget)),
            keep_name);
  if (const auto* address = std::get_if<scenario::SshAddress>(&target))
    move_to(condition, board_at(*address), keep_name);
  if (!options.simulator.empty()) condition.simulator = options.simulator;
  if (options.slowdown) scenario::slow_down(condition, *options.slowdown);
  // On a machine of another speed. It is the same condition: its name stays.
  if (options.cpu_time_scale && condition.clock == scenario::Clock::kCpu)
    condition.cpu_factor *= *options.cpu_time_scale;
  if (!options.unknown_stages.empty())
    scenario::set_unknown_stages(condition, options.unknown_stages);
  return condition;
}

/// Rejects --tunnel if it has no effect.
void require_use_of_tunnel(const runner::TrialSpec& spec) {
  if (!spec.uses_tunnel || spec.has_sut_at(runner::SutPlace::kBoard)) return;
  throw Error(ErrorCode::kUsage,
              "--tunnel needs a SUT on a board. Select the board with --target "
              "ssh://[user@]board[:port] or a target file with its address, or omit --tunnel")
      .about("--tunnel");
}

runner::TrialSpec make_spec(const RunOptions& options) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  runner::TrialSpec spec;
  std::vector<scenario::Setting> settings;
  for (const std::string& text : options.settings)
    settings.push_back(scenario::parse_setting(text, std::filesystem::current_path()));
  spec.scenario = scenario::load_scenario(
      find_file(shipped, scenario::ShippedKind::kScenario, options.scenario, FileKind::kScenario),
      settings);
  spec.scenario.record_images |= options.record_images;
  spec.scenario.world_options = world_options(options.reading, shipped);
  if (!options.profile.empty())
    scenario::lay_profile(spec.scenario,
                          scenario::load_profile(find_file(shipped, scenario::ShippedKind::kProfile,
                                                           options.profile, FileKind::kProfile)));
  spec.condition = make_condition(spec.scenario, options, shipped);
  spec.seed = options.seed;
  spec.folder = options.out.empty() ? "out" / campaign::trial_folder(spec.scenario.name,
                                                                     spec.condition.name, spec.seed)
                                    : options.out;
  if (options.out.empty() || options.force) spec.earlier = runner::EarlierRun::kReplace;
  if (!options.listen.empty()) {
    const auto address = link::parse_address(options.listen);
    if (!address)
      throw Error(ErrorCode::kUsage, "--listen: " + address.failure().message).about("--listen");
    spec.listen = *address;
  }
  spec.waits_for_sut = std::holds_alternative<WaitForSut>(parse_target_option(options.target));
  spec.uses_tunnel = options.tunnel;
  spec.worlds = options.worlds;
  require_use_of_tunnel(spec);
  return spec;
}

/// The lines below the outcome: a label and a text.
using Rows = std::vector<std::pair<std::string, std::string>>;

void print(const Rows& rows) {
  std::size_t width = 0;
  for (const auto& [label, text] : rows) width = std::max(width, label.size());
  for (const auto& [label, text] : rows) fmt::print("  {:<{}}  {}\n", label, width, text);
}

std::string text_of(const campaign::MetricValue& metric, const std::string& reason) {
  const std::string unit = metric.unit == "1" ? "" : " " + metric.unit;
  const std::string value = metric.value ? fmt::format("{:.4g}{}", *metric.value, unit)
                            : metric.missing_because == reason ? "none"
                                                               : "none: " + metric.missing_because;
  return value + (metric.max   ? fmt::format("  (limit {:.4g})", *metric.max)
                  : metric.min ? fmt::format("  (at least {:.4g})", *metric.min)
                               : "");
}

std::string text_of(const campaign::UavContacts& own) {
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

std::string text_of(const judge::ClauseVerdict& clause, bool is_evaluated) {
  if (!is_evaluated) return "not evaluated";
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
  if (result.clock == scenario::name(scenario::Clock::kUnstamped))
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

void print_result(const runner::TrialSpec& spec, const campaign::TrialResult& result) {
  fmt::print("{}",
             report::verdict_text(report::verdicts_of(report::results_of_run(result), spec.folder),
                                  report::Markup::kPlain));
  const bool has_failed = result.outcome == campaign::Outcome::kFailed;  // its reason is an error
  fmt::print("{} under \"{}\", seed {}: {}{}\n", result.scenario, result.condition, result.seed,
             campaign::name(result.outcome), has_failed ? "" : ": " + result.reason);
  Rows rows;
  for (const auto& metric : result.metrics)
    rows.emplace_back(metric.label, text_of(metric, result.reason));
  for (const auto& clause : result.clauses)
    rows.emplace_back(clause.name, text_of(clause, !has_failed));
  for (const campaign::UavEnergy& energy : result.energy) {
    rows.emplace_back("energy of " + energy.uav, energy_text(energy));
    rows.emplace_back("charge of " + energy.uav, charge_text(energy));
  }
  for (const campaign::UavContacts& own : result.contacts) rows.emplace_back(own.uav, text_of(own));
  add_circumstances(rows, result);
  if (result.audit) rows.emplace_back("audit", result.audit->summary);
  for (const std::string& note : result.this_run.notes) rows.emplace_back("note", note);
  if (std::filesystem::exists(spec.folder / runner::kRecordFile))
    rows.emplace_back("record", (spec.folder / runner::kRecordFile).string());
  print(rows);
}

int run_and_print(const RunOptions& options, const std::stop_token& stop) {
  const runner::TrialSpec spec = make_spec(options);
  campaign::TrialResult result;
  {
    StatusLine line;
    runner::TrialObserver observer;
    if (!options.quiet) {
      observer.warn = [&](const std::string& text) { line.print("warning: " + text); };
      observer.on_warnings = [&](const std::vector<Warning>& warnings) {
        line.print(summary_of(warnings, (spec.folder / runner::kWarningsFile).string()));
      };
      observer.on_status = [&](const coordinator::RunStatus& status) { line.show(status); };
      observer.on_setup = [&](const std::string& text) { line.show(text); };
      observer.on_blocked = [&](const std::string& text) { line.print(text); };
    }
    observer.on_refused = [](const std::string& text) { say("warning: {}\n", text); };
    observer.on_listening = [](const std::string& text) {
      say("Waiting for the SUT to connect. Start it with:\n{}", text);
    };
    result = runner::run_trial(spec, find_back_end, observer, stop);
  }
  if (!options.junit.empty())
    os::write_file_atomically(options.junit,
                              report::to_junit(report::read_run_results(spec.folder), spec.folder));
  if (options.json)
    fmt::print("{}\n", campaign::to_json(result));
  else if (!options.quiet)
    print_result(spec, result);
  if (result.outcome == campaign::Outcome::kFailed) say("tether: {}\n", result.reason);
  return campaign::exit_code(result.outcome);
}

}  // namespace

int run_one(const RunOptions& options, const std::stop_token& stop) {
  return with_junit(options.junit, options.scenario.string(),
                    [&] { return run_and_print(options, stop); });
}

void read_world_ahead(const RunOptions& options, sim::WorldStore& worlds) {
  const runner::TrialSpec spec = make_spec(options);
  worlds.load(scenario::world_request(spec.scenario, spec.seed), nullptr);
}

}  // namespace tether::app
