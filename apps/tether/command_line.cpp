#include "command_line.h"

#include "commands.h"

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include <CLI/CLI.hpp>

#include <tether/base/error.h>
#include <tether/base/version.h>

// All that needs CLI11, which is expensive to compile.
namespace tether::app {

namespace {

using Action = std::function<int(const std::stop_token& stop)>;

constexpr const char* kFooter =
    R"(Exit codes: 0 goal reached, 1 goal missed, 2 wrong use or a bad file, 3 set-up failed.

Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether campaign face_anchor --out out/face_anchor
  tether audit out/face_anchor/face_anchor/host/seed-0001/record.mcap)";

/// `--simulator`, of every command that flies.
void add_simulator_option(CLI::App& command, std::string& simulator) {
  command.add_option("--simulator", simulator,
                     "What plays the world, over what the condition says: mujoco, in this program; "
                     "gazebo, which is started and ended by it; or where a simulator listens, "
                     "unix:/path or tcp://host:port");
}

// Each adds a subcommand to the program, and sets `action` when it is chosen.

void add_run_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "Run one trial of a scenario");
  command->add_option("scenario", options->scenario, "Name of a shipped scenario, or a file (TOML)")
      ->required();
  command->add_option("--condition", options->condition,
                      "Condition of the scenario; its first one if not given");
  command->add_option("--profile", options->profile,
                      "Profile of the sensors (a shipped one's name, or a file), laid over the "
                      "scenario's settings");
  command->add_option("--seed", options->seed, "Seed of noise, delays and start poses")
      ->check(CLI::Range(0.0, 9007199254740992.0))
      ->capture_default_str();
  command->add_option(
      "--out", options->out,
      "Folder for result.json, record.mcap and the SUT's log [out/SCENARIO/CONDITION/seed-N]");
  command
      ->add_option("--real-time-factor", options->real_time_factor,
                   "Simulate at most this fast against the wall clock")
      ->check(CLI::Range(1e-3, 1e4));
  command->add_option("--listen", options->listen, "Address for the SUT; port 0 takes a free one")
      ->capture_default_str();
  command->add_option(
      "--target", options->target,
      "Where the SUT runs, over what the condition says: the name of a shipped target, or a file "
      "(TOML); "
      "ssh://[user@]board[:port]; or \"wait\": do not start the SUT, print what to type where it "
      "runs, and wait for it");
  add_simulator_option(*command, options->simulator);
  command->add_flag("--tunnel", options->tunnel,
                    "The board's SUT comes through the SSH connection, where it cannot reach this "
                    "machine; costs the board the encryption of every image");
  command->add_flag("--images", options->record_images,
                    "Keep the camera images that the SUT consumed in the record");
  command->add_flag("--json", options->json, "Print result.json instead of a summary");
  command->add_flag("--quiet", options->quiet, "Print errors and warnings only");
  command->footer(R"(Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether run face_anchor --target six_times_slower
  tether run face_anchor --target ssh://pi@board.local
  tether run face_anchor --profile ideal
  tether run face_anchor --simulator gazebo
  tether run face_anchor --images --out out/one)");
  command->callback([options, &action] {
    action = [options](const std::stop_token& stop) { return run_one(*options, stop); };
  });
}

void add_campaign_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<CampaignOptions>();
  CLI::App* command =
      program.add_subcommand("campaign", "Run many trials: scenarios x conditions x seeds");
  command->add_option("campaign", options->campaign, "Name of a shipped campaign, or a file (TOML)")
      ->required();
  command->add_option("--out", options->out, "Folder for the trials [out/CAMPAIGN]");
  command
      ->add_option(
          "--jobs", options->jobs,
          "Number of parallel trials. Rejected if parallel runs would distort measured time")
      ->capture_default_str();
  add_simulator_option(*command, options->simulator);
  command->add_flag("--resume", options->resume, "Go on with a folder: run only what is missing");
  command->footer(R"(Examples:
  tether campaign face_anchor --out out/face_anchor
  tether campaign face_anchor --out out/face_anchor --resume
  tether campaign face_anchor --simulator gazebo --out out/face_anchor_gazebo)");
  command->callback([options, &action] {
    action = [options](const std::stop_token& stop) { return run_campaign(*options, stop); };
  });
}

void add_report_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      program.add_subcommand("report", "Tables and plots of a campaign's results, or of one run's");
  command->add_option("folder", options->folder, "Folder of a campaign or of a run")->required();
  command
      ->add_option("--format", options->format,
                   "text, markdown, csv (one row per trial and metric), summary-csv (one row per "
                   "condition and metric), or html (one self-contained page; needs gnuplot)")
      ->check(CLI::IsMember({"text", "markdown", "csv", "summary-csv", "html"}))
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "File to write [standard output; of html: report.html in the folder]");
  command->footer(R"(Examples:
  tether report out/face_anchor
  tether report out/face_anchor --format html
  tether report out/one --format html --out one.html
  tether report out/face_anchor --format csv --out trials.csv)");
  command->callback([options, &action] {
    action = [options](const std::stop_token&) { return report(*options); };
  });
}

void add_frames_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<FramesOptions>();
  CLI::App* command = program.add_subcommand(
      "frames", "Recorded camera images with the ROI that the SUT tracked and the true one");
  command->add_option("record", options->record, "record.mcap of a run with --images")->required();
  command->add_option("--out", options->out,
                      "Folder for the pictures (SVG) [frames, beside the record]");
  command->footer(R"(Example:
  tether run face_anchor --images --out out/one
  tether frames out/one/record.mcap)");
  command->callback([options, &action] {
    action = [options](const std::stop_token&) { return draw_frames(*options); };
  });
}

void add_plot_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command = program.add_subcommand(
      "plot", "ST and ET against wall time, lag, and the path from above, as SVG");
  command->add_option("record", options->record, "record.mcap of a run")->required();
  command->add_option("--out", options->out, "Folder for the plots [plots, beside the record]");
  command->footer(
      R"(Writes timeline.svg (the whole run), timeline_zoom.svg (its first interactions), lag.svg (not of a
run without synchronisation: nothing lags there) and path.svg. Needs gnuplot.

Example:
  tether plot out/one/record.mcap)");
  command->callback([options, &action] {
    action = [options](const std::stop_token&) { return draw_plots(*options); };
  });
}

void add_audit_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = program.add_subcommand(
      "audit", "Check a record against the rules of time, from the record alone");
  command->add_option("record", options->record, "record.mcap of a run")->required();
  command->add_option("--max-findings", options->max_findings, "Print at most this many")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  command->footer(R"(Exit code 0: every rule is kept; 1: not, or the record has no end.

Example:
  tether audit out/one/record.mcap)");
  command->callback([options, &action] {
    action = [options](const std::stop_token&) { return audit_record(*options); };
  });
}

void add_list_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "list", "List the scenarios, campaigns, worlds, profiles and targets that Tether ships");
  command->footer(
      "`tether run`, `tether campaign`, --profile and --target take these names in place of a "
      "file.");
  command->callback([&action] { action = [](const std::stop_token&) { return list_shipped(); }; });
}

void add_target_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* target = program.add_subcommand("target", "Machines that a SUT may run on");
  target->require_subcommand(1);
  target->footer("Examples:\n  tether target check ssh://pi@board.local");
  CLI::App* check =
      target->add_subcommand("check", "Report what on a machine would disturb a measurement");
  check->add_option("address", options->address,
                    "ssh://[user@]board[:port]; this machine if not given");
  check->add_flag("--json", options->json, "Print findings and readings as JSON");
  check->footer(
      R"(Exit codes: 0 fine, 1 something would disturb a measurement, 2 wrong use, 3 not reachable.

Examples:
  tether target check
  tether target check ssh://pi@board.local)");
  check->callback([options, &action] {
    action = [options](const std::stop_token& stop) { return check_target(*options, stop); };
  });
}

}  // namespace

int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt) {
  CLI::App program{
      "Reports whether a UAV's computer is fast enough for its task, before anything flies."};
  program.name("tether");
  program.footer(kFooter);
  program.set_version_flag("--version", std::string(version()));
  program.require_subcommand(1);

  Action action;
  add_run_command(program, action);
  add_campaign_command(program, action);
  add_report_command(program, action);
  add_audit_command(program, action);
  add_frames_command(program, action);
  add_plot_command(program, action);
  add_target_command(program, action);
  add_list_command(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? 0 : exit_code(ErrorCode::kUsage);
  }
  interrupt.emplace();
  return action(interrupt->token());
}

}  // namespace tether::app
