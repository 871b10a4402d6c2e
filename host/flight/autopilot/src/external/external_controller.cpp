#include "external/external_controller.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

bool is_one_of(std::int64_t value, std::initializer_list<std::uint8_t> values) {
  return std::ranges::find(values, value) != values.end();
}

// Of AUTOPILOT_VERSION.
Version version_of(const mavlink::Message& m) {
  constexpr unsigned kMajor = 24, kMinor = 16, kPatch = 8, kByte = 0xff;
  const auto number = static_cast<std::uint32_t>(m.integer("flight_sw_version"));
  return {number >> kMajor, (number >> kMinor) & kByte, (number >> kPatch) & kByte};
}

}  // namespace

ExternalController::ExternalController(const ExternalSettings& settings, std::string_view name,
                                       Version oldest, UdpPort&& link, os::ChildCommand command)
    : settings_(settings),
      name_(fmt::format("{} of UAV '{}'", name, settings.vehicle.name)),
      link_(std::move(link)),
      program_(name_, std::move(command)),
      oldest_(oldest),
      gimbal_(settings.vehicle.joints),
      of_gimbal_({static_cast<std::uint8_t>(settings.instance + 1), kGimbal}) {}

// By the sensors with which it flies: their biases are there already.
void ExternalController::boot(const Sensed& at_rest) {
  for (booted_ = settings_.period; !has_booted(booted_); booted_ += settings_.period)
    advance(booted_, at_rest.truth, readings_of(settings_, at_rest));
  require_version();
  sent_.clear();  // nobody was there
}

void ExternalController::require_version() const {
  const std::string oldest = fmt::format("{}.{} or later", oldest_[0], oldest_[1]);
  if (!version_)
    throw Error(ErrorCode::kSetup,
                fmt::format("{} has not told its version within {:.0f} s of its time (MAVLink's "
                            "AUTOPILOT_VERSION). If it needs longer to boot, increase 'boot_s'; "
                            "'path' must be a build of version {}. See its log, {}",
                            name_, to_seconds(booted_), oldest, program_.log().string()));
  if (*version_ < oldest_)
    throw Error(ErrorCode::kSetup, fmt::format("{} is version {}. Use {}: give its build as 'path'",
                                               name_, version(), oldest));
}

std::string ExternalController::version() const {
  return version_ ? fmt::format("{}", fmt::join(*version_, ".")) : "";
}

Actions ExternalController::step(const Sensed& sensed, const std::vector<Bytes>& received) {
  Actions actions;
  const std::vector<Bytes> for_it = point_gimbal(received);
  if (!for_it.empty()) pass_on(for_it);
  advance(booted_ + sensed.at.time_since_epoch(), sensed.truth, readings_of(settings_, sensed));
  is_set_down_ = is_set_down_ || set_down_.is_done(sensed.at, sensed.truth);
  actions.setpoint = SetDown::setpoint();
  if (is_set_down_) {
    actions.setpoint = uav::Setpoint{.mask = uav::kRotorSpeeds};
    for (const double share : rotor_shares())
      actions.setpoint->rotor_speeds_rad_s.push_back(
          share * settings_.vehicle.airframe.max_rotor_speed_rad_s);
  }
  gimbal_.add_to(*actions.setpoint);
  actions.sent = of_gimbal_.take();
  std::ranges::move(std::exchange(sent_, {}), std::back_inserter(actions.sent));
  return actions;
}

std::vector<Bytes> ExternalController::point_gimbal(const std::vector<Bytes>& received) {
  std::vector<Bytes> rest;
  for (const Bytes& datagram : received) {
    const auto frames = mavlink::Decoder().push_datagram(datagram);
    bool is_taken = !frames.empty();
    for (const mavlink::Frame& frame : frames) {
      const mavlink::Message& m = frame.message;
      const bool is_own = is_command(m) && gimbal_.takes(to_command(m)) &&
                          is_one_of(m.integer("target_system"), {0, of_gimbal_.own().system}) &&
                          is_one_of(m.integer("target_component"), {0, kAutopilot, kGimbal});
      is_taken = is_taken && is_own;
      if (!is_own) continue;
      const Command command = to_command(m);
      of_gimbal_.send(acknowledgement(command, gimbal_.run(command), frame.from));
    }
    if (!is_taken) rest.push_back(datagram);
  }
  return rest;
}

void ExternalController::serve_link() {
  for (Bytes& datagram : link_.receive()) take_datagram(std::move(datagram));
}

void ExternalController::take_datagram(Bytes datagram) {
  const auto frames = mavlink::Decoder().push_datagram(datagram);
  bool is_own = !frames.empty();
  for (const mavlink::Frame& frame : frames) {
    if (frame.message.is("AUTOPILOT_VERSION")) version_ = version_of(frame.message);
    is_own = take(frame.message) && is_own;
  }
  if (!is_own) sent_.push_back(std::move(datagram));
}

void ExternalController::send(const mavlink::Message& message) {
  link_.send(mavlink::encode(message, kSimulator, sequence_++));
}

void ExternalController::command(int id, double param1) {
  send(mavlink::Message("COMMAND_LONG")
           .set("command", id)
           .set("param1", param1)
           .set("target_system", settings_.instance + 1)
           .set("target_component", 1));
}

void ExternalController::request(int message_id) {
  constexpr int kCommand = 512;
  command(kCommand, message_id);
}

void prepare_folders(const ExternalSettings& settings,
                     const std::vector<std::filesystem::path>& needed, std::string_view what) {
  std::error_code none;
  for (const std::filesystem::path& file : needed)
    if (!std::filesystem::exists(settings.build / file, none))
      throw Error(ErrorCode::kSetup, {settings.build.string()},
                  fmt::format("has no {}. 'path' must be {}", file.string(), what))
          .about(settings.build.string());
  std::filesystem::remove_all(settings.folder, none);
  std::filesystem::create_directories(settings.folder, none);
}

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// UAVs of PX4 beyond the tenth would share ports; systems of MAVLink are numbered with a byte.
constexpr std::array kExternals = {
    External{.key = "px4",
             .name = "PX4",
             .period = milliseconds(4),  // of its own simulations
             .boot = seconds(30),
             .most_uavs = 10,
             .has_fixed_ports = true,
             .repeats = false,  // load and clocks of the machine are among what it tells
             .start = start_px4},
    External{.key = "ardupilot",
             .name = "ArduPilot",
             .period = milliseconds(1),
             .boot = seconds(90),
             .most_uavs = 250,
             .has_fixed_ports = false,
             .repeats = true,
             .start = start_ardupilot},
};

}  // namespace

std::span<const External> externals() {
  return kExternals;
}

bool is_external_parameter(std::string_view name) {
  constexpr std::size_t kLongest = 16;
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace tether::autopilot
