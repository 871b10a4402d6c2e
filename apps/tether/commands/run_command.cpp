#include "back_ends.h"
#include "commands/commands.h"
#include "options/junit_option.h"
#include "options/simulator_option.h"
#include "options/target_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/say.h"
#include "terminal/status_line.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/result.h>
#include <tether/os/program.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/page.h>
#include <tether/report/run_text.h>
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
  for (scenario::Computer& own : condition.computers)
    if (options.cpu_time_scale && own.clock.kind == computer::ClockKind::kCpu)
      own.clock.factor *= *options.cpu_time_scale;
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
  spec.was_tried = options.worlds != nullptr;  // by the campaign that keeps them
  require_use_of_tunnel(spec);
  return spec;
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
    observer.on_refused = [](const std::string& text) { complain("warning: " + text); };
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
    print(report::run_text(result, spec.folder, markup_of_stdout()));
  // A person has read the reason on the same terminal.
  const bool is_read = !options.json && !options.quiet && os::terminal_columns(STDOUT_FILENO) > 0 &&
                       os::terminal_columns(STDERR_FILENO) > 0;
  if (result.outcome == campaign::Outcome::kFailed && !is_read)
    complain("tether: " + result.reason);
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
