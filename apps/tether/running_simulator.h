#pragma once

#include "simulator_option.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>
#include <tether/sim_gazebo/gazebo_simulator.h>

namespace tether::app {

/// What a simulator is started with.
struct SimulatorSetup {
  Duration answer_limit{0};   ///< how long one outside of this process may take for an answer
  std::filesystem::path log;  ///< gets what processes of its own print
  sim::WarningSink warn;
  std::function<void(const std::string&)> on_setup{};    ///< told what is being started
  std::function<void(const std::string&)> on_silence{};  ///< told when an answer is long in coming
  std::stop_token stop{};                                ///< ends all waiting for it
};

/// @throws Error(kBadFile) with file and line for what that simulator cannot read.
void require_readable(const sim::World& world, const SimulatorOption& option);

/// The simulator of one run, with the processes that it takes; they end with the object. Not
/// thread-safe.
class RunningSimulator {
 public:
  /// Starts it, or connects to it. @throws Error(kSetup) with the reason why it is not to be had.
  RunningSimulator(const SimulatorOption& option, sim::World world, SimulatorSetup setup);

  sim::Simulator& get() { return gazebo_ ? gazebo_->get() : *simulator_; }
  /// Why it is lost, as far as its processes show it; none: it is not.
  std::optional<std::string> lost();
  /// After it failed with `said`: what else is known of its end, with "; " before.
  std::string post_mortem(const std::string& said);

 private:
  void attach(const sim::protocol::Endpoint& endpoint, sim::World world,
              const SimulatorSetup& setup);

  std::unique_ptr<sim::GazeboSimulator> gazebo_;
  std::unique_ptr<sim::Simulator> simulator_;
};

}  // namespace tether::app
