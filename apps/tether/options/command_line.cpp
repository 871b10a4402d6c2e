#include "options/command_line.h"

#include "commands/commands.h"
#include "shared/complaint.h"
#include "shared/completion.h"
#include "shared/help.h"
#include "shared/within.h"
#include "terminal/print.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/os/program.h>
#include <tether/os/terminal.h>
#include <tether/scenario/shipped_files.h>

// The options of all commands, with their help texts. Of this program, only this source includes
// CLI11, which is expensive to compile. docs/man/tether.1 describes the same options.
namespace tether::app {

namespace {

using Action = std::function<int(const std::stop_token& stop)>;

constexpr const char* kFooter =
    R"(Exit codes: 0 goal reached, 1 goal missed, 2 wrong use or a bad file, 3 set-up failed, or no
answer because a program waited or computed in ways that Tether does not see.

Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether campaign face_anchor --out out/campaign
  tether size face_anchor --target six_times_slower
  tether audit out/campaign/face_anchor/host/seed-0001/record.mcap

`tether list` prints the shipped files. Guides: docs/guide of the source, or
/usr/share/doc/tether/guide.)";

/// Adds a subcommand; if it is chosen, `action` calls `run` with the options that were parsed.
template <class Options>
std::pair<CLI::App*, std::shared_ptr<Options>> add_command(
    CLI::App& program, Action& action, const char* name, const char* description,
    int (*run)(const Options&, const std::stop_token&)) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(name, description);
  command->callback([options, run, &action] {
    action = [options, run](const std::stop_token& stop) { return run(*options, stop); };
  });
  return {command, options};
}

void add_simulator_option(CLI::App& command, std::string& simulator) {
  command.add_option("--simulator", simulator,
                     "Simulator to use instead of the condition's: mujoco (embedded), gazebo "
                     "(started and ended by tether), or the address of an external simulator, "
                     "unix:/path or tcp://host:port");
}

void add_reading_options(CLI::App& command, ReadingOptions& reading) {
  command
      .add_option(
          "--missing-models", reading.missing_models,
          "What to do about an included model, a mesh or a texture that is not found: error, "
          "or placeholder (go without it, and name it in the result)")
      ->check(CLI::IsMember({"error", "placeholder"}))
      ->capture_default_str();
  command.add_flag(
      "--tolerant", reading.tolerant,
      "Correct impossible inertias of the world and the UAVs, and name them in the result");
}

void add_junit_option(CLI::App& command, std::filesystem::path& junit) {
  command.add_option(
      "--junit", junit,
      "Also write the results as JUnit's XML for continuous integration: a test case "
      "for each outcome, metric and clause; of tether size, for the answer and each "
      "target");
}

void add_engine_options(CLI::App& command, EngineOptions& engine) {
  command.add_option("--engine", engine.engine,
                     "Have the flights flown by other processes or machines: name of a shipped "
                     "engine (such as slurm or parallel), or a file (TOML). They must share the "
                     "folder of --out");
  command
      .add_option("--engine-option", engine.settings,
                  "NAME=VALUE: an option of the engine, several times if you like, as in "
                  "\"options=--partition=fast\"")
      ->type_name("NAME=VALUE");
}

void add_run_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "run", "Run one trial of a scenario", run_one);
  command->add_option("scenario", options->scenario, "Name of a shipped scenario, or a file (TOML)")
      ->required();
  command->add_option("--condition", options->request.condition,
                      "Condition of the scenario [its first one]");
  command->add_option("--profile", options->profile,
                      "Sensor profile that overrides the scenario's settings: name of a shipped "
                      "profile, or a file (TOML)");
  command->add_option("--seed", options->request.seed, "Seed of noise, delays and start poses")
      ->check(within(0.0, 9007199254740992.0))
      ->capture_default_str();
  command->add_option("--out", options->request.folder,
                      "Folder for result.json, record.mcap and the SUT's log. A folder with an "
                      "earlier run needs --force [out/SCENARIO/CONDITION/seed-N; replaces the "
                      "earlier run]");
  command->add_flag("--force", options->request.replaces_earlier,
                    "Replace the earlier run in the folder of --out: remove all of its files, "
                    "with its reports, plots and frames");
  command
      ->add_option("--real-time-factor", options->request.real_time_factor,
                   "Maximum speed of the simulation relative to the wall clock")
      ->check(within(1e-3, 1e4))
      ->type_name("FACTOR");
  command
      ->add_option("--cpu-time-scale", options->request.cpu_time_scale,
                   "With the clock \"cpu\": count CPU time so many times, because this machine is "
                   "that much faster than the one of other runs")
      ->check(within(1e-3, 1e3))
      ->type_name("FACTOR");
  command
      ->add_option("--slowdown", options->request.slowdown,
                   "Make the SUT's computer so many times slower than the condition's")
      ->check(within(1e-3, 1e4))
      ->type_name("FACTOR");
  command->add_option("--unknown-stages", options->request.unknown_stages,
                      "With the clock \"replayed\": time of stages that were not recorded, "
                      "instead of the condition's unknown_stages: refused (the run ends), counted "
                      "or zero");
  command
      ->add_option(
          "--set", options->settings,
          "Set a value of the scenario, given by its key's path: time_limit_s=30, "
          "cpu_factor=4 (of each [[condition]] that has it), \"uav.position_m=[1, 0, 1]\", "
          "sut.parameters.yaw_rate_deg_s=40, uavs=2 (the first two); can be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--listen", options->request.listen,
                   "Address for the SUT, host:port; port 0 selects a free port")
      ->capture_default_str();
  command->add_option("--target", options->target,
                      "Where the SUT runs, instead of the condition's target: name of a shipped "
                      "target, a file (TOML), or a board, ssh://[user@]board[:port]; with "
                      "\"wait\", print the command that starts the SUT and wait for it to connect");
  add_simulator_option(*command, options->request.simulator);
  command->add_flag("--tunnel", options->request.uses_tunnel,
                    "Tunnel the SUT's connection through SSH, for a board that cannot reach this "
                    "machine; the board must then decrypt every image");
  command->add_flag("--images", options->request.record_images,
                    "Record the camera images that the SUT reads");
  command->add_flag("--json", options->json, "Print result.json instead of a summary");
  add_junit_option(*command, options->junit);
  add_reading_options(*command, options->reading);
  command->add_flag("--quiet", options->quiet, "Print only errors");
  command->footer(R"(Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether run face_anchor --target six_times_slower
  tether run face_anchor --target ssh://pi@board.local
  tether run face_anchor --profile ideal
  tether run face_anchor --simulator gazebo
  tether run face_anchor --images --out out/one)");
}

void add_campaign_command(CLI::App& program, Action& action) {
  const auto [command, options] = add_command(program, action, "campaign",
                                              "Run the trials of a campaign: scenarios x "
                                              "conditions x seeds",
                                              run_campaign);
  command->add_option("campaign", options->campaign,
                      "Name of a shipped campaign, or a file (TOML)");
  command->add_option("--out", options->out, "Folder for the trials [out/campaigns/CAMPAIGN]");
  command->add_option("--jobs", options->jobs,
                      "Number of parallel trials [1], or of shards of an engine. Rejected if "
                      "parallel runs would distort measured time");
  command
      ->add_option("--shard", options->shard,
                   "Fly only part K of N: each N-th trial, from the K-th on. Other parts can be "
                   "flown at the same time, in the same or another folder")
      ->type_name("K/N");
  add_engine_options(*command, options->engine);
  command->add_option("--collect", options->collect,
                      "Bring the results of these folders of a campaign together in the first one, "
                      "or in that of --out, and report what is missing");
  command->add_option("--listed", options->listed,
                      "Fly the trials of this list, which an engine's script names");
  add_simulator_option(*command, options->simulator);
  add_junit_option(*command, options->junit);
  add_reading_options(*command, options->reading);
  command->add_flag("--resume", options->resume,
                    "Continue a campaign: run only the trials without a result");
  command->footer(R"(Examples:
  tether campaign face_anchor --out out/campaign
  tether campaign face_anchor --out out/campaign --resume
  tether campaign face_anchor --out /shared/campaign --engine slurm --engine-option "options=--time=2:00:00"
  tether campaign face_anchor --out part3 --shard 3/8
  tether campaign --collect part1 part2 part3 --out all
  tether campaign face_anchor --simulator gazebo --out out/campaign_gazebo)");
}

void add_size_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "size",
                  "Find the slowest sufficient computer, or how many UAVs it carries", size);
  command->add_option("scenario", options->scenario, "Name of a shipped scenario, or a file (TOML)")
      ->required();
  command
      ->add_option("--axis", options->axis,
                   "What to vary: how slow the computer may be, or how many UAVs it carries")
      ->check(CLI::IsMember({"slowdown", "uavs"}))
      ->capture_default_str();
  command->add_option("--condition", options->condition,
                      "Condition to size [the scenario's first one]");
  command->add_option("--target", options->targets,
                      "Virtual target to evaluate, several times if you like: name of a shipped "
                      "target, or a file (TOML)");
  command
      ->add_option("--success", options->success,
                   "Share of flights that must reach the goal, above 0 and below 1")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      ->add_option("--confidence", options->confidence,
                   "Confidence of the answer's interval, above 0 and below 1")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      ->add_option("--interval", options->interval,
                   "Stop when its upper bound is at most so many times the lower one [1.3]")
      ->type_name("FACTOR");
  command
      ->add_option("--between", options->between,
                   "Slowdowns [1,40], or numbers of UAVs [1, all], to fly: LEAST,MOST")
      ->delimiter(',')
      ->expected(2)
      ->type_name("LEAST,MOST");
  command->add_option("--max-trials", options->max_trials, "Maximum number of flights")
      ->check(within(1.0, 10000.0))
      ->capture_default_str();
  command->add_option("--unsynchronised", options->unsynchronised,
                      "Condition without synchronisation to compare: fly it with the same "
                      "slowdowns and seeds, which doubles the flights");
  command->add_option("--jobs", options->jobs,
                      "Number of parallel flights [1], or of shards of an engine. Rejected if "
                      "parallel runs would distort measured time");
  add_engine_options(*command, options->engine);
  command->add_option("--out", options->out,
                      "Output folder [out/size/SCENARIO; for UAVs, SCENARIO-uavs]");
  command->add_flag("--resume", options->resume, "Continue with the flights in the folder");
  command->add_flag("--force", options->force, "Remove the earlier flights in the folder");
  add_junit_option(*command, options->junit);
  add_simulator_option(*command, options->simulator);
  add_reading_options(*command, options->reading);
  command->footer(
      R"(Exit codes: 0 every --target is sufficient, or none is given, some computer of --between is, and
the answer is as narrow as --interval asks (of UAVs: decided), 1 otherwise, 2 wrong use or a bad
file, 3 interrupted, or flights failed.

Examples:
  tether size face_anchor --condition target
  tether size face_anchor --target six_times_slower --jobs 2
  tether size face_anchor --success 0.95 --interval 1.2 --max-trials 600
  tether size face_anchor --condition target --unsynchronised "target, no sync"
  tether size four_on_one_board --axis uavs)");
}

void add_report_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "report", "Report the results of a campaign or a run", report);
  command->add_option("folder", options->folder, "Folder of a campaign or a run")->required();
  command
      ->add_option("--format", options->format,
                   "text, markdown, csv (one row per trial and metric), summary-csv (one row per "
                   "condition and metric), or html (one self-contained page; needs gnuplot)")
      ->check(CLI::IsMember({"text", "markdown", "csv", "summary-csv", "html"}))
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "File to write [standard output; for html, report.html in the folder]");
  command->footer(R"(Examples:
  tether report out/campaign
  tether report out/campaign --format html
  tether report out/one --format html --out one.html
  tether report out/campaign --format csv --out trials.csv)");
}

void add_frames_command(CLI::App& program, Action& action) {
  const auto [command, options] = add_command(program, action, "frames",
                                              "Extract the recorded images: colours with the "
                                              "tracked and the true ROI (SVG), depths [mm] and "
                                              "labels (16-bit PNG)",
                                              draw_frames);
  command->add_option("record", options->record, "record.mcap of a run with --images")->required();
  command->add_option("--out", options->out, "Folder for the images [frames, next to the record]");
  command->footer(R"(Example:
  tether run face_anchor --images --out out/images
  tether frames out/images/record.mcap)");
}

void add_plot_command(CLI::App& program, Action& action) {
  const auto [command, options] = add_command(
      program, action, "plot",
      "Plot ST and ET over wall time, the lag, and the path of a run (SVG)", draw_plots);
  command->add_option("record", options->record, "record.mcap of a run")->required();
  command->add_option("--out", options->out, "Folder for the plots [plots, next to the record]");
  command->footer(
      R"(Writes timeline.svg (the whole run), timeline_zoom.svg (its first interactions), lag.svg (only
for synchronised runs) and path.svg. Needs gnuplot.

Example:
  tether plot out/one/record.mcap)");
}

void add_audit_command(CLI::App& program, Action& action) {
  const auto [command, options] = add_command(
      program, action, "audit", "Check a record against the rules of time", audit_record);
  command->add_option("record", options->record, "record.mcap of a run")->required();
  command
      ->add_option("--max-findings", options->max_findings, "Maximum number of findings to print")
      ->check(within(0.0, 1e9))
      ->capture_default_str();
  command->footer(
      R"(Exit codes: 0 all rules are kept, 1 a rule is violated or the record is incomplete.

Example:
  tether audit out/one/record.mcap)");
}

void add_timing_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "timing",
                  "Report what each stage of a program computes, or how "
                  "that changed",
                  time_stages);
  command
      ->add_option("runs", options->runs,
                   "Runs of one program in one scenario: records, folders of runs, timing files")
      ->required();
  command->add_option("--out", options->out,
                      "Timing file to write, for conditions with clock = \"replayed\"");
  command->add_option("--counted", options->counted,
                      "Runs of the same program under a counted target: --out then also has the "
                      "work of each stage, for mode = \"scaled\"");
  command->add_option("--csv", options->csv, "Table to write as CSV, in seconds");
  command->add_option("--html", options->html, "Page to write, with a histogram of each stage");
  command->add_option("--against", options->against,
                      "Earlier run or timing file: print the change of each stage instead, with "
                      "its 95 % interval");
  command
      ->add_option("--limit", options->limit_percent,
                   "With --against: the most by which a stage may become slower")
      ->check(within(0.0, 1e6))
      ->type_name("PERCENT");
  command->add_flag("--json", options->json, "Print the table, or the change, as JSON");
  command->add_option("--junit", options->junit,
                      "With --limit: also write the change as JUnit's XML for continuous "
                      "integration, with a test case for each stage");
  command->footer(
      R"(Exit codes: 0 no stage is slower than --limit allows, or there is no limit, 1 one is, 2 wrong
use or a bad file.

Examples:
  tether timing out/one/record.mcap
  tether timing out/campaign/face_anchor/target/seed-* --out board.timing
  tether timing out/new --against board.timing --limit 10
  tether timing out/new --against board.timing --limit 10 --junit timing.xml)");
}

void add_list_command(CLI::App& program, Action& action) {
  const auto [command, options] =
      add_command(program, action, "list",
                  "List the scenarios, campaigns, worlds, profiles and targets that Tether ships",
                  list_shipped);
  command->footer(
      "You can pass these names to `tether run`, `tether campaign`, --profile and --target instead "
      "of a file.");
}

void add_world_command(CLI::App& program, Action& action) {
  CLI::App* world = program.add_subcommand("world", "Check worlds before a flight");
  world->require_subcommand(1);
  world->footer("Examples:\n  tether world check room");
  const auto [check, options] = add_command(
      *world, action, "check",
      "Read a world, and print the parts that are not simulated as written", check_world);
  check->add_option("world", options->world, "Name of a shipped world, or a file (SDF)")
      ->required();
  add_reading_options(*check, options->reading);
  check->footer(
      R"(Exit codes: 0 the world can be used, 2 it cannot, or wrong use.

Examples:
  tether world check room
  tether world check warehouse.sdf --missing-models placeholder)");
}

void add_target_command(CLI::App& program, Action& action) {
  CLI::App* target = program.add_subcommand("target", "Check machines on which a SUT can run");
  target->require_subcommand(1);
  target->footer("Examples:\n  tether target check ssh://pi@board.local");
  const auto [check, options] =
      add_command(*target, action, "check", "Report what would disturb a measurement on a machine",
                  check_target);
  check->add_option("address", options->address, "ssh://[user@]board[:port] [this machine]");
  check->add_flag("--json", options->json, "Print findings and readings as JSON");
  check->footer(
      R"(Exit codes: 0 nothing would disturb a measurement, 1 something would, 2 wrong use,
3 the machine cannot be reached.

Examples:
  tether target check
  tether target check ssh://pi@board.local)");
}

/// What to do about a word that no command takes here.
std::string advice_on(const std::string& word) {
  for (const char* option : {"--trials", "--flights", "--seeds"})
    if (word == option)
      return "The number of flights is `trials` of a campaign's file, and --max-trials of tether "
             "size.";
  return scenario::ShippedFiles::of_program(os::own_file()).what_is(word);
}

}  // namespace

int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt) {
  CLI::App program{"Tests in simulation whether a UAV's computer is fast enough for its task."};
  program.name("tether");
  program.footer(kFooter);
  program.set_version_flag("--version", std::string(version()));
  program.require_subcommand(1);
  program.formatter(help_format(os::text_columns(STDOUT_FILENO)));  // of the commands too

  Action action;
  for (const auto add :
       {add_run_command, add_campaign_command, add_size_command, add_report_command,
        add_audit_command, add_timing_command, add_frames_command, add_plot_command,
        add_world_command, add_target_command, add_list_command})
    add(program, action);
  std::string shell;
  add_completion_command(program, shell)->callback([&] {
    action = [&](const std::stop_token&) {
      fmt::print("{}", completion_script(program, shell));
      return 0;
    };
  });
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return program.exit(e);  // --help, --version
    complain("tether: " + complaint(program, e, advice_on));
    return exit_code(ErrorCode::kUsage);
  }
  interrupt.emplace();
  return action(interrupt->token());
}

}  // namespace tether::app
