#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/campaign/run_campaign.h>
#include <tether/shards/shard.h>

/// What runs the shards of a campaign and waits for them: Slurm, GNU parallel, … An engine is a
/// file (data/engines/*.toml, docs/guide/clusters.md), so that users can write their own.
namespace tether::shards {

struct Engine {
  std::filesystem::path file;
  /// Run it, and it returns when all shards have ended. Its exit code does not matter. In these
  /// words and in `input`, {name} stands for a value of EngineCall or an option of the engine.
  std::vector<std::string> command;
  std::string input{};                           ///< for its standard input
  std::vector<std::string> cancel{};             ///< ends the shards of a run that was interrupted
  std::size_t shards = 1;                        ///< unless the user says otherwise
  std::map<std::string, std::string> options{};  ///< with their defaults

  /// Whether it can give a shard several cores of its own.
  bool gives_cores() const;
};

/// Reads and checks an engine's file.
/// @throws Error(kBadFile), with file and line, for unknown keys and {names}.
Engine load_engine(const std::filesystem::path& file);

/// Replaces options by "NAME=VALUE". @throws Error(kUsage) about --engine-option for a name that
/// the engine does not have.
void set_options(Engine& engine, const std::vector<std::string>& settings);

/// What a run of an engine fills in.
struct EngineCall {
  std::string name;              ///< unique; letters, digits and '-', as in Kubernetes
  std::filesystem::path folder;  ///< for its logs
  std::filesystem::path script;  ///< runs the shard whose number is its argument
  std::size_t shards = 1;
  int cores = 1;  ///< that each shard needs
};
/// `text` with the values in place of their {names}; paths are words of a shell.
std::string filled(const std::string& text, const Engine& engine, const EngineCall& call);
std::vector<std::string> filled(const std::vector<std::string>& words, const Engine& engine,
                                const EngineCall& call);

struct EngineSetup {
  Engine engine;
  std::size_t shards = 1;                    ///< at most
  std::filesystem::path campaign;            ///< its folder
  std::vector<std::filesystem::path> files;  ///< on which results depend
  std::string shard_command;  ///< of a shell: flies the list of trials that is its next word
  std::function<std::string(const campaign::TrialPlan&)> request;  ///< of a plan, as text
  std::function<void(const std::string&)> tell;                    ///< one line
  /// How often to look for results.
  Duration look_period = std::chrono::seconds(1);
};

/// Has trials flown by the shards of an engine, which share the campaign's folder. What a killed
/// shard or a lost machine leaves is flown again, in up to three calls of the engine. Not
/// thread-safe.
/// @param plans with folders below the campaign's; their results are missing.
/// @param done_before trials with a result, for the progress.
/// @returns `interrupted` after a stop request: the shards are cancelled, and results are kept.
/// @throws Error(kUsage) about --engine if the trials must not run beside others, or need cores
///   that the engine cannot give; Error(kSetup) if it cannot be started, or if a call brings no
///   result, with the last words of the engine or of a shard.
campaign::CampaignOutcome fly_by_engine(const EngineSetup& setup,
                                        std::span<const campaign::TrialPlan* const> plans,
                                        std::size_t done_before, const std::stop_token& stop,
                                        const campaign::ProgressCallback& progress);

}  // namespace tether::shards
