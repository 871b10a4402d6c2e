#include "options/common_options.h"

#include <tether/os/child_process.h>

namespace tether::app {

Options reading_options(ReadingOptions& reading) {
  return {{"--strict",
           "Reject a world with parts that are not found or cannot be used. Without this option, "
           "they are left out or corrected, and named in the result",
           &reading.strict},
          {"--tolerant",
           "Also leave out or correct parts of the UAVs' models: inertias that no body can have, "
           "meshes that are not found",
           &reading.tolerant}};
}

Options engine_options(EngineOptions& options) {
  return {{"--jobs",
           "Number of parallel flights [1], or of shards of an engine. Rejected if parallel runs "
           "would distort measured time",
           &options.jobs},
          {"--engine ENGINE",
           "Have the flights flown by other processes or machines: name of a shipped engine (such "
           "as slurm or parallel), or a file (TOML). They must share the folder of --out",
           &options.engine},
          {"--engine-option NAME=VALUE",
           "An option of the engine, several times if you like, as in \"options=--partition=fast\"",
           &options.settings}};
}

Allowed named() {
  return checked([](const std::string& name) { return name.empty() ? "must not be empty" : ""; });
}

std::string how_to_continue() {
  std::string text = "to continue, type: tether";
  bool continues = false;
  for (const std::string& word : os::own_arguments()) {
    if (word == "--force") continue;
    continues |= word == "--resume" || word == "--shard";
    text += " " + os::shell_word(word);
  }
  return text + (continues ? "" : " --resume");
}

Option scenario_argument(std::filesystem::path& scenario) {
  return {"scenario", "Name of a shipped scenario, or a file (TOML)", &scenario, required()};
}

Option record_argument(std::filesystem::path& record) {
  return {"record", "record.mcap of a run", &record, required()};
}

Option condition_option(std::string& condition) {
  return {"--condition NAME", "Condition of the scenario [its first one]", &condition, named()};
}

Option simulator_option(std::string& simulator) {
  return {
      "--simulator SIMULATOR",
      "Simulator to use instead of the condition's: mujoco (embedded), gazebo (started and ended "
      "by tether), or the address of an external simulator, unix:/path or tcp://host:port",
      &simulator};
}

Option junit_option(std::filesystem::path& junit) {
  return {
      "--junit FILE",
      "Also write the results as JUnit's XML for continuous integration: a test case for each "
      "outcome, metric and clause; of tether size, for the answer and each target. The file exists "
      "however the command ends. An existing file is replaced only if it is a JUnit file",
      &junit};
}

Option resume_option(bool& resumes) {
  return {"--resume", "Continue with what is in the folder: fly only what has no result", &resumes};
}

}  // namespace tether::app
