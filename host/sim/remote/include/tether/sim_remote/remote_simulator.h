#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>
#include <tether/sim_protocol/connection.h>

namespace tether::sim {

/// How patient the host is with a simulator outside of its process.
struct RemoteOptions {
  /// Until the answer to Open; for any other answer.
  Duration open_limit = std::chrono::seconds(60);
  Duration answer_limit = std::chrono::seconds(30);
  /// Asked some ten times a second while an answer is awaited. A text: give up, because of it ("the
  /// simulator was ended by signal 9").
  std::function<std::optional<std::string>()> why_give_up;
  /// Told, once for each answer, when it has not come for a second; of that to Open only where the
  /// simulator has an address: one that we start ourselves takes its time.
  std::function<void(const std::string&)> on_silence{};
  /// Where it listens, for messages until it has said what it is called; may be empty.
  std::string address{};
};

/// A simulator at the other end of a connection, with the world's UAVs put into it. Dynamics, rays
/// and ideal pictures are its own; sensors are made of them by the sensing library, as the embedded
/// back end's are.
///
/// `world` is what load_world made of the SDF files that the simulator itself reads.
/// @throws Error(kSetup) when the simulator is lost, silent for too long, or answers nonsense, at
/// any call; Error(kBadFile) with file and line where the world cannot be sent.
std::unique_ptr<Simulator> make_remote_simulator(World world,
                                                 std::unique_ptr<protocol::Connection> connection,
                                                 RemoteOptions options, const WarningSink& warn);

}  // namespace tether::sim
