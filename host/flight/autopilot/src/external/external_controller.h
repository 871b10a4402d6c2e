#pragma once

#include "external/held_program.h"
#include "external/ports.h"
#include "external/readings.h"
#include "mount.h"
#include "outbox.h"
#include "set_down.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/autopilot/external.h>
#include <tether/mavlink/frame.h>
#include <tether/mavlink/message.h>

namespace tether::autopilot {

/// Who this program is, on MAVLink.
inline constexpr mavlink::Address kSimulator{.system = 255, .component = 190};

/// Major and minor number, and patch.
using Version = std::array<unsigned, 3>;

/// What flight controllers that the user brings have in common: the program, its link to the
/// companion, its boot on the ground, and what a step is. A class for each kind has its interface
/// to simulators. Not thread-safe.
class ExternalController : public FlightController {
 public:
  void boot(const Sensed& at_rest) final;
  Actions step(const Sensed& sensed, const std::vector<Bytes>& received) final;
  std::string version() const final;

 protected:
  /// Starts `command`. `link` is where it sends MAVLink to. Versions before `oldest` do not fly.
  ExternalController(const ExternalSettings& settings, std::string_view name, Version oldest,
                     UdpPort&& link, os::ChildCommand command);

  /// It is given what the companion has sent, and has taken all of it.
  virtual void pass_on(const std::vector<Bytes>& received) = 0;
  /// One step, up to this instant of its time, in which it has computed, and sent what it sends.
  virtual void advance(Duration at, const uav::BodyState& truth, const Readings& readings) = 0;
  /// Whether the flight can begin at this instant of its time. Called at each step of the boot.
  /// @throws Error(kSetup) if it takes too long
  virtual bool has_booted(Duration at) = 0;
  /// Of the rotors' largest speed.
  virtual std::vector<double> rotor_shares() const = 0;
  /// A message from it. Whether it is an answer to this program, and not for the companion.
  virtual bool take(const mavlink::Message& message) = 0;

  /// Takes what it has sent over its link to the companion.
  void serve_link();
  void send(const mavlink::Message& message);
  /// A command of MAVLink to it, with its first parameter.
  void command(int id, double param1 = 0.0);
  /// Asks it once for a message of that type (MAV_CMD_REQUEST_MESSAGE).
  void request(int message_id);

  const ExternalSettings settings_;
  const std::string name_;  ///< for people: of which UAV it is
  UdpPort link_;
  HeldProgram program_;

  static constexpr int kVersionMessage = 148;  // AUTOPILOT_VERSION

 private:
  /// @throws Error(kSetup) if it has not told a version that can fly
  void require_version() const;
  void take_datagram(Bytes datagram);
  /// Leaves what the gimbal has not taken.
  std::vector<Bytes> point_gimbal(const std::vector<Bytes>& received);

  const Version oldest_;
  std::uint8_t sequence_ = 0;
  std::vector<Bytes> sent_;
  /// The vehicle's gimbal is a device of its own, beside the controller.
  Mount gimbal_;
  Outbox of_gimbal_;
  std::optional<Version> version_;
  Duration booted_{0};
  SetDown set_down_;
  bool is_set_down_ = false;
};

/// The folder of the controller's build must have these files; its own folder is made anew.
/// @throws Error(kSetup) if one is missing: 'path' must be `what`
void prepare_folders(const ExternalSettings& settings,
                     const std::vector<std::filesystem::path>& needed, std::string_view what);

std::unique_ptr<FlightController> start_px4(const ExternalSettings& settings);
std::unique_ptr<FlightController> start_ardupilot(const ExternalSettings& settings);

}  // namespace tether::autopilot
