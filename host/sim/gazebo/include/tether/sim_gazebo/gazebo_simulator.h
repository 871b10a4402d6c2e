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

/// What Gazebo is started with.
struct GazeboSetup {
  Duration answer_limit{0};   ///< how long it may take for an answer
  std::filesystem::path log;  ///< gets what its processes print
  WarningSink warn;
  std::function<void(const std::string&)> on_silence{};  ///< told when an answer is long in coming
  std::stop_token stop{};                                ///< ends all waiting for it
};

/// Gazebo 11 with a world open in it, for one run. Its processes end with the object. Not
/// thread-safe.
class GazeboSimulator {
 public:
  /// Starts it. @throws Error(kSetup) with the reason why it is not to be had.
  GazeboSimulator(World world, const GazeboSetup& setup);
  ~GazeboSimulator();
  GazeboSimulator(const GazeboSimulator&) = delete;
  GazeboSimulator& operator=(const GazeboSimulator&) = delete;

  Simulator& get() { return *simulator_; }
  /// Why it is lost, as far as its processes show it; none: it is not.
  std::optional<std::string> lost();
  /// After it failed with `said`: what else is known of its end, with "; " before.
  std::string post_mortem(const std::string& said);

 private:
  std::optional<std::string> why_give_up();

  std::stop_token stop_;
  std::unique_ptr<GazeboServer> server_;  // outlives the simulator, which is connected to it
  std::unique_ptr<Simulator> simulator_;
};

}  // namespace tether::sim
