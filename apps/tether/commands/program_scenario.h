#pragma once

#include "shared/option.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/error.h>
#include <tether/scenario/shipped_files.h>

/// The scenario of `tether run -- PROGRAM`, made of options. It is the text of a file, which is
/// read like any other.
namespace tether::app {

/// What is not given has the default of `program_rows`.
struct ProgramOptions {
  std::vector<std::string> command;  ///< what follows "--"; empty: a scenario flies
  std::optional<std::string> world, model, flight_controller, controller_path;
  std::optional<std::vector<double>> position_m;
  std::optional<double> time_limit_s, cpu_factor;
  std::vector<std::string> anchors;
  bool starts_in_air = false;
  bool uses_library = false;
  bool has_one_process = false;
};

/// The program, and the options that only it has.
Options program_rows(ProgramOptions& options);

/// @throws Error(kUsage), about the option, if one of those is given that need a program.
void require_no_program_options(ProgramOptions options);

struct ProgramScenario {
  std::string name;  ///< of the script or program
  std::string text;
  std::map<int, std::string> options;  ///< "--world yard", by line of the text that they decide
};
/// @param profile of the UAV's sensors; empty: the default
/// @throws Error(kUsage), about the option, if a name is neither a file nor shipped.
ProgramScenario make_program_scenario(const ProgramOptions& options, const std::string& profile,
                                      const scenario::ShippedFiles& shipped);

/// An error about a line that an option decided is about that option; any other one is the same.
Error about_option(const Error& error, const std::filesystem::path& file,
                   const ProgramScenario& made);

/// The file of a made scenario, in the folder of its flights. Unless `keep` is called, it is
/// removed again with its folders, if they were not there before.
class ProgramScenarioFile {
 public:
  /// @throws Error(kUsage), about the file, if there is another one, which was not made.
  ProgramScenarioFile(const std::filesystem::path& folder, const ProgramScenario& made);
  ~ProgramScenarioFile();
  ProgramScenarioFile(const ProgramScenarioFile&) = delete;
  ProgramScenarioFile& operator=(const ProgramScenarioFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void keep() { new_.clear(); }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> new_;  ///< it and its folders, from the innermost one
};

}  // namespace tether::app
