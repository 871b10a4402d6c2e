#pragma once

#include "shared/option.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

/// The subcommands of `tether`, one file each with all that is theirs: options, help and action.
namespace tether::app {

struct Command {
  std::string words;  ///< "run", "world check"
  std::string help;
  Options options{};
  std::string footer{};  ///< of the help: exit codes, examples
  /// Returns the exit code of the program. Long ones end early after a stop request. Empty: the
  /// command only has subcommands.
  std::function<int(const std::stop_token&)> run{};
};

/// @param rows the options that are stored in a value of type Given; `run` gets it.
template <class Given>
Command make_command(const char* words, const char* help, Options (*rows)(Given&),
                     const char* footer, int (*run)(const Given&, const std::stop_token&)) {
  const auto given = std::make_shared<Given>();  // copies of the command lead to the same value
  return {words, help, rows(*given), footer,
          [given, run](const std::stop_token& stop) { return run(*given, stop); }};
}

Command run_command();
Command campaign_command();
Command size_command();
Command report_command();
Command audit_command();
Command timing_command();
Command frames_command();
Command plot_command();
Command world_check_command();
Command model_check_command();
Command target_check_command();
Command cache_command();
Command list_command();

/// Brings the results of folders of one campaign together in the first one, and prints them.
int collect_campaign(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& junit);

}  // namespace tether::app
