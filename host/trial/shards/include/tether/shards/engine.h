#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

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

}  // namespace tether::shards
