#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>

namespace tether::sim {

class GazeboServer;

/// How Gazebo is started.
struct GazeboSetup {
  Duration answer_limit{0};   ///< time limit of an answer
  std::filesystem::path log;  ///< for the output of its processes
  WarningSink warn;
  std::function<void(const std::string&)> on_silence{};  ///< called while an answer is late
  std::stop_token stop{};                                ///< ends all waiting
};

/// Gazebo 11 with a world open in it, for one run. Its processes end with the object. Not
/// thread-safe.
class GazeboSimulator {
 public:
  /// Starts it. @throws Error(kSetup) with the reason if it cannot be started.
  GazeboSimulator(World world, const GazeboSetup& setup);
  ~GazeboSimulator();
  GazeboSimulator(const GazeboSimulator&) = delete;
  GazeboSimulator& operator=(const GazeboSimulator&) = delete;

  Simulator& get() { return *simulator_; }
  /// How one of its processes ended; none while all run.
  std::optional<std::string> lost();
  /// After a failure: what is known of the end of its processes and was not reported by `lost` or
  /// an error of the simulator, with "; " before.
  std::string post_mortem();

 private:
  std::optional<std::string> why_give_up();

  std::stop_token stop_;
  std::unique_ptr<GazeboServer> server_;  // outlives the simulator, which is connected to it
  std::unique_ptr<Simulator> simulator_;
};

}  // namespace tether::sim
