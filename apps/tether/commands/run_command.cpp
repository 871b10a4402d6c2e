#include "back_ends.h"
#include "commands/commands.h"
#include "commands/program_scenario.h"
#include "options/common_options.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/say.h"
#include "terminal/status_line.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/campaign/folder_claim.h>
#include <tether/campaign/result.h>
#include <tether/os/child_process.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/report.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>
#include <tether/runner/trial_request.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>
#include <tether/sim_sdf/load_world.h>

/// `tether run`: makes a request of the options, runs its trial with the status on stderr, and
/// prints the result.
namespace tether::app {

namespace {

struct RunOptions {
  runner::TrialRequest request;    ///< but for what the following members name
  std::filesystem::path scenario;  ///< empty: it is made for the program
  ProgramOptions program;
  std::string target;
  std::filesystem::path profile;
  std::vector<std::string> settings;  ///< "KEY=VALUE"
  ReadingOptions reading;
  bool json = false;
  bool quiet = false;
  std::filesystem::path junit;
};

/// The file that the user means, which is not of another kind.
std::filesystem::path find_file(const scenario::ShippedFiles& shipped, scenario::ShippedKind kind,
                                const std::filesystem::path& given, FileKind wanted) {
  const std::filesystem::path file = shipped.find(kind, given);
  require_kind(file, wanted);
  return file;
}

runner::TrialRequest make_request(const RunOptions& options,
                                  const std::filesystem::path& made_scenario = {}) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const auto find = [&](scenario::ShippedKind kind, const std::filesystem::path& given,
                        FileKind wanted) {
    return std::filesystem::absolute(find_file(shipped, kind, given, wanted));
  };
  runner::TrialRequest request = options.request;
  const bool is_made = !made_scenario.empty();  // its profile is in it
  request.scenario =
      is_made ? made_scenario
              : find(scenario::ShippedKind::kScenario, options.scenario, FileKind::kScenario);
  if (is_made && options.program.cpu_factor) {
    if (request.condition.empty()) request.condition = "target";
    if (request.condition != "target")
      refuse_option("--cpu-factor", fmt::format("flies the condition \"target\", not \"{}\". Leave "
                                                "out one of the two options.",
                                                request.condition));
  }
  for (const std::string& text : options.settings)
    request.settings.push_back(scenario::parse_setting(text, std::filesystem::current_path()));
  request.reading = world_options(options.reading, shipped);
  if (!options.profile.empty() && !is_made)
    request.profile = find(scenario::ShippedKind::kProfile, options.profile, FileKind::kProfile);
  request.target = runner::parse_target_choice(options.target);
  if (auto* file = std::get_if<std::filesystem::path>(&request.target))
    *file = find(scenario::ShippedKind::kTarget, *file, FileKind::kTarget);
  return request;
}

int run_and_print(const RunOptions& options, const runner::TrialRequest& request,
                  const std::stop_token& stop) {
  sim::WorldStore worlds(sim::FileCache::of_user());
  runner::TrialSpec spec = runner::make_trial(request);
  spec.worlds = &worlds;
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
                              report::to_junit(report::results_of_run(result), spec.folder));
  if (options.json)
    fmt::print("{}\n",
               report::with_answer(campaign::to_json(result),
                                   report::verdicts_of(report::results_of_run(result)).front()));
  else if (!options.quiet)
    print(report::run_text(result, spec.folder, markup_of_stdout()));
  // A person has read the reason on the same terminal.
  const bool is_read = !options.json && !options.quiet && os::terminal_columns(STDOUT_FILENO) > 0 &&
                       os::terminal_columns(STDERR_FILENO) > 0;
  if (result.outcome == campaign::Outcome::kFailed && !is_read)
    complain("tether: " + result.reason);
  return campaign::exit_code(result);
}

/// A scenario for the program that is not yet in a folder of a flight.
void require_room(const runner::TrialRequest& request) {
  const auto kind = request.folder.empty() ? std::nullopt : kind_of(request.folder);
  if (kind == FileKind::kCampaignFolder || (kind == FileKind::kRun && !request.replaces_earlier))
    campaign::refuse_folder(
        request.folder, kind == FileKind::kRun
                            ? "has a run. Choose another folder with --out, or replace that run "
                              "with --force."
                            : "has a campaign. Choose another folder with --out.");
}

int run_program(const RunOptions& options, const std::stop_token& stop) {
  const ProgramScenario made =
      make_program_scenario(options.program, options.profile.string(),
                            scenario::ShippedFiles::of_program(os::own_file()));
  require_room(options.request);
  const std::filesystem::path& folder = options.request.folder;
  ProgramScenarioFile file(folder.empty() ? "out" / std::filesystem::path(made.name) : folder,
                           made);
  try {
    const int code = run_and_print(options, make_request(options, file.path()), stop);
    file.keep();
    if (!options.quiet && !options.json)
      print(fmt::format(
          "The scenario of this flight, to change and to fly again: {}\n",
          os::shell_word(file.path().lexically_proximate(std::filesystem::current_path()))));
    return code;
  } catch (const Error& error) {
    throw about_option(error, file.path(), made);
  }
}

int run_one(const RunOptions& options, const std::stop_token& stop) {
  const bool has_program = !options.program.command.empty();
  if (!has_program) require_no_program_options(options.program);
  const std::string suite =
      has_program ? options.program.command.front() : options.scenario.string();
  return with_junit(options.junit, suite, [&] {
    return has_program ? run_program(options, stop)
                       : run_and_print(options, make_request(options), stop);
  });
}

Options run_rows(RunOptions& o) {
  return concatenated(
      {{{"scenario", "Name of a shipped scenario, or a file (TOML). Or a program follows --",
         &o.scenario},
        condition_option(o.request.condition),
        {"--profile PROFILE",
         "Sensor profile that overrides the scenario's settings: name of a shipped profile, or a "
         "file (TOML)",
         &o.profile},
        {"--seed", "Seed of noise, delays and start poses", &o.request.seed,
         range(0, kLargestWhole)},
        {"--out FOLDER",
         "Folder for result.json, record.mcap and the SUT's log. A folder with an earlier run "
         "needs --force [out/SCENARIO/CONDITION/seed-N, where the earlier run is replaced]",
         &o.request.folder},
        {"--force",
         "Replace the earlier run in the folder of --out: remove all of its files, with its "
         "reports, plots and frames",
         &o.request.replaces_earlier},
        {"--real-time-factor FACTOR", "Maximum speed of the simulation relative to the wall clock",
         &o.request.real_time_factor, range(1e-3, 1e4)},
        {"--cpu-time-scale FACTOR",
         "With the clock \"cpu\": count CPU time so many times, because this machine is that much "
         "faster than the one of other runs",
         &o.request.cpu_time_scale, range(1e-3, 1e3)},
        {"--slowdown FACTOR", "Make the SUT's computer so many times slower than the condition's",
         &o.request.slowdown, range(1e-3, 1e4)},
        {"--unknown-stages ACTION",
         "With the clock \"replayed\": time of stages that were not recorded, instead of the "
         "condition's unknown_stages: refused (the run ends), counted or zero",
         &o.request.unknown_stages},
        {"--set KEY=VALUE",
         "Set a value of the scenario, given by its key's path: time_limit_s=30, cpu_factor=4 (of "
         "each [[condition]] that has it), \"uav.position_m=[1, 0, 1]\", "
         "sut.parameters.yaw_rate_deg_s=40, uavs=2 (the first two); can be repeated",
         &o.settings,
         {.is_one_each = true}},
        {"--listen ADDRESS",
         "Address for the SUT, host:port; port 0 selects a free port [a free port of 127.0.0.1; "
         "for a board, of the address at which it sees this machine]",
         &o.request.listen},
        {"--target TARGET",
         "Where the SUT runs, instead of the condition's target: name of a shipped target, a file "
         "(TOML), or a board, ssh://[user@]board[:port]; with \"wait\", print the command that "
         "starts the SUT and wait for it to connect",
         &o.target},
        simulator_option(o.request.simulator),
        {"--tunnel",
         "Tunnel the SUT's connection through SSH, for a board that cannot reach this machine; the "
         "board must then decrypt every image",
         &o.request.uses_tunnel},
        {"--images", "Record the camera images that the SUT reads", &o.request.record_images},
        {"--json", "Print result.json with the answer, instead of a summary", &o.json},
        junit_option(o.junit)},
       program_rows(o.program),
       reading_options(o.reading),
       {{"--quiet", "Print only errors", &o.quiet}}});
}

}  // namespace

Command run_command() {
  return make_command("run", "Run one trial of a scenario", run_rows, R"(Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether run face_anchor --target six_times_slower
  tether run face_anchor --target ssh://pi@board.local
  tether run face_anchor --profile ideal
  tether run face_anchor --simulator gazebo
  tether run face_anchor --images --out out/one
  tether run -- ./my_program --its options
  tether run --world room --position=-1,1,0.1 --cpu-factor 8 -- python3 my_program.py)",
                      run_one);
}

}  // namespace tether::app
