#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <tether/runner/trial_request.h>

/// The subcommands of `tether`, one file each; command_line.cpp parses their options. Each returns
/// the exit code of the program. The long ones end early after a stop request.
namespace tether::app {

/// How worlds are read.
struct ReadingOptions {
  bool tolerant = false;
  std::string missing_models = "error";  ///< "error" or "placeholder"
};

struct RunOptions {
  runner::TrialRequest request;  ///< but for what the following members name
  std::filesystem::path scenario;
  std::string target;
  std::filesystem::path profile;
  std::vector<std::string> settings;  ///< "KEY=VALUE"
  ReadingOptions reading;
  bool json = false;
  bool quiet = false;
  std::filesystem::path junit;
};
/// Runs one trial and prints its result.
int run_one(const RunOptions& options, const std::stop_token& stop);

/// What runs the shards of a campaign.
struct EngineOptions {
  std::string engine;                 ///< name of a shipped one, or a file; empty: none
  std::vector<std::string> settings;  ///< "NAME=VALUE", of its options
};

struct CampaignOptions {
  std::filesystem::path campaign;
  std::vector<std::filesystem::path> collect;  ///< folders of a campaign
  std::filesystem::path listed;                ///< a list of an engine's shards
  std::filesystem::path out;
  std::string shard;  ///< "K/N"
  std::string simulator;
  std::optional<int> jobs;
  EngineOptions engine;
  ReadingOptions reading;
  bool resume = false;
  std::filesystem::path junit;
};
/// Runs many trials: scenarios x conditions x seeds.
int run_campaign(const CampaignOptions& options, const std::stop_token& stop);
/// Brings the results of its folders together, and prints them.
int collect_campaign(const CampaignOptions& options);

/// The campaign in the folder of `tether size` is called this and the scenario's name. Names of
/// campaign files have no spaces.
inline constexpr std::string_view kSizePrefix = "size of ";

/// What `tether size` leaves in its folder, beside the page and the flights.
inline constexpr const char* kSizeFile = "size.json";
inline constexpr const char* kSizeDrawing = "size.svg";

struct SizeOptions {
  std::filesystem::path scenario;
  std::string axis = "slowdown";  ///< or "uavs"
  std::string condition;
  std::string unsynchronised;
  std::vector<std::filesystem::path> targets;
  std::filesystem::path out;
  std::string simulator;
  double success = 0.9;
  double confidence = 0.95;
  std::optional<double> interval;
  std::optional<std::vector<double>> between;
  std::size_t max_trials = 300;
  std::optional<int> jobs;
  EngineOptions engine;
  ReadingOptions reading;
  bool resume = false;
  bool force = false;
  std::filesystem::path junit;
};
/// Finds the slowest computer that is sufficient for a scenario.
int size(const SizeOptions& options, const std::stop_token& stop);

struct ReportOptions {
  std::filesystem::path folder;
  std::string format = "text";
  std::filesystem::path out;
};
/// Prints or writes the results of a campaign or a run.
int report(const ReportOptions& options, const std::stop_token&);

struct FramesOptions {
  std::filesystem::path record;
  std::filesystem::path out;
};
/// Draws the recorded camera images with their ROIs.
int draw_frames(const FramesOptions& options, const std::stop_token&);

struct PlotOptions {
  std::filesystem::path record;
  std::filesystem::path out;
};
/// Draws ST and ET over wall time, the lag, and the path.
int draw_plots(const PlotOptions& options, const std::stop_token&);

struct AuditOptions {
  std::filesystem::path record;
  std::size_t max_findings = 20;
};
/// Checks a record against the rules of time.
int audit_record(const AuditOptions& options, const std::stop_token&);

struct TimingOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path against;
  std::optional<double> limit_percent;
  std::vector<std::filesystem::path> counted;
  std::filesystem::path out;
  std::filesystem::path csv;
  std::filesystem::path html;
  std::filesystem::path junit;
  bool json = false;
};
/// Prints what each stage of a program computes, or how it changed.
int time_stages(const TimingOptions& options, const std::stop_token&);

struct ListOptions {};
/// Prints the names and descriptions of the files that Tether ships.
int list_shipped(const ListOptions&, const std::stop_token&);

struct WorldCheckOptions {
  std::filesystem::path world;
  ReadingOptions reading;
};
/// Reads a world as a run does, and prints what of it is not simulated as written.
int check_world(const WorldCheckOptions& options, const std::stop_token&);

struct CheckOptions {
  std::string address;
  bool json = false;
};
/// Reports what would disturb a measurement on a machine.
int check_target(const CheckOptions& options, const std::stop_token& stop);

}  // namespace tether::app
