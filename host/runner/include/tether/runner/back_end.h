#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>

/// What a trial needs of simulators. Which there are is up to the program.
namespace tether::runner {

/// What a simulator is started with.
struct SimulatorSetup {
  Duration answer_limit{0};   ///< how long one outside of this process may take for an answer
  std::filesystem::path log;  ///< gets what processes of its own print
  sim::WarningSink warn;
  std::function<void(const std::string&)> on_setup{};    ///< told what is being started
  std::function<void(const std::string&)> on_silence{};  ///< told when an answer is long in coming
  std::stop_token stop{};                                ///< ends all waiting for it
};

/// The simulator of one run, with the processes that it takes; they end with the object. Not
/// thread-safe.
class RunningSimulator {
 public:
  virtual ~RunningSimulator() = default;

  virtual sim::Simulator& get() = 0;
  /// Why it is lost, as far as its processes show it; none: it is not.
  virtual std::optional<std::string> lost() { return std::nullopt; }
  /// After it failed with `said`: what else is known of its end, with "; " before.
  virtual std::string post_mortem(const std::string& /*said*/) { return ""; }
};

/// A simulator that a condition may name.
struct BackEnd {
  /// @throws Error(kBadFile) with file and line for what it cannot read.
  std::function<void(const sim::World&)> require_readable;
  /// Starts it, or connects to it. @throws Error(kSetup) with the reason why it is not to be had.
  std::function<std::unique_ptr<RunningSimulator>(sim::World, const SimulatorSetup&)> start;
  /// Its own, which a result rests on. @throws Error(kSetup) when one is missing.
  std::function<std::vector<std::filesystem::path>()> files;
};

/// @throws Error(kUsage) for a name of none.
using FindBackEnd = std::function<BackEnd(const std::string& name)>;

}  // namespace tether::runner
