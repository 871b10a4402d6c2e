#pragma once

#include <functional>
#include <stop_token>

#include <CLI/CLI.hpp>

/// The subcommands of `tether`, a file each. Every function adds one to the program; its action
/// returns the exit code.
namespace tether::app {

/// Ends early when a stop is requested, where it can.
using Action = std::function<int(const std::stop_token& stop)>;

/// Sets `action` when the subcommand is chosen.
void add_run_command(CLI::App& program, Action& action);
void add_campaign_command(CLI::App& program, Action& action);
void add_report_command(CLI::App& program, Action& action);
void add_frames_command(CLI::App& program, Action& action);
void add_plot_command(CLI::App& program, Action& action);
void add_audit_command(CLI::App& program, Action& action);
void add_target_command(CLI::App& program, Action& action);

}  // namespace tether::app
