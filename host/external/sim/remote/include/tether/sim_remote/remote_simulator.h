#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim {

/// Time limits for an external simulator, and what is called while it does not answer.
struct RemoteOptions {
  /// Time limit of the answer to Open, and of any other answer.
  Duration open_limit = std::chrono::seconds(60);
  Duration answer_limit = std::chrono::seconds(30);
  /// Called about ten times a second while waiting for an answer. If it returns a reason ("the
  /// simulator was ended by signal 9"), the wait ends with an error of that text.
  std::function<std::optional<std::string>()> why_give_up;
  /// Called, once for each answer, after a second without it; for Open only if `address` is set.
  std::function<void(const std::string&)> on_silence{};
  /// Where the simulator listens, for messages before its name is known; may be empty.
  std::string address{};
};

/// The protocol's pictures have colours only, and the simulator decides how it samples them.
/// @throws Error(kBadFile) for a depth, RGBD or segmentation camera, located at the sensor and
/// about its name; for an antialiased camera, located where that was set and about "antialias".
void require_remote_cameras(const World& world);

/// A simulator at the other end of a connection, with the world's UAVs added to it. It provides
/// dynamics, rays and ideal pictures; the sensing library makes the samples from them, as for the
/// embedded back end.
///
/// `world` is the result of load_world for the SDF files that the simulator itself reads.
/// @throws Error(kSetup) if the simulator is lost, exceeds a time limit or violates the protocol,
/// at any call; Error(kBadFile) if the world cannot be sent.
std::unique_ptr<Simulator> make_remote_simulator(World world,
                                                 std::unique_ptr<protocol::Connection> connection,
                                                 RemoteOptions options, const WarningSink& warn);

}  // namespace tether::sim
