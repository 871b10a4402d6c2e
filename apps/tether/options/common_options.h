#pragma once

#include "shared/option.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Options and arguments that several commands have.
namespace tether::app {

/// How worlds are read.
struct ReadingOptions {
  bool strict = false;
  bool tolerant = false;
};
Options reading_options(ReadingOptions& reading);

/// How many trials are flown beside each other, and what runs them.
struct EngineOptions {
  std::optional<int> jobs;
  std::string engine;                 ///< name of a shipped one, or a file; empty: none
  std::vector<std::string> settings;  ///< "NAME=VALUE", of its options
};
Options engine_options(EngineOptions& options);

/// What a name may be: anything but nothing, as of a variable of a shell that is not set.
Allowed named();
/// "to continue, type: tether campaign face_anchor --out out --resume": this call, continued.
std::string how_to_continue();

Option scenario_argument(std::filesystem::path& scenario);
Option record_argument(std::filesystem::path& record);
Option condition_option(std::string& condition);
Option simulator_option(std::string& simulator);
Option junit_option(std::filesystem::path& junit);
Option resume_option(bool& resumes);

}  // namespace tether::app
