// One step: what the companion has sent lies at ArduPilot's port; then the vehicle's state gives it
// its new time. It takes both, computes, sends MAVLink, and then its servos, and waits for the next
// state. So its servos show that the step is done, and nothing depends on how long that took.

#include "external/external_controller.h"
#include "external/json.h"
#include "external/motor_layout.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/machine.h>

namespace tether::autopilot {
namespace {

using std::chrono::seconds;

// The options and servos of older ones differ.
constexpr Version kOldestArduPilot = {4, 5, 0};
constexpr Duration kLongestStep = std::chrono::milliseconds(4);

MotorLayout layout_of(const ExternalSettings& settings) {
  const auto layout = motor_layout(settings.vehicle.airframe.rotors);
  if (!layout)
    throw Error(ErrorCode::kSetup,
                fmt::format("ArduPilot has no frame with the rotors of UAV '{}'. It can fly 4, 6 "
                            "or 8 rotors in + or x configuration",
                            settings.vehicle.name));
  return *layout;
}

/// What ArduPilot must know of the vehicle, and of the simulation.
std::map<std::string, double> ardupilot_parameters(const ExternalSettings& settings) {
  const uav::MultirotorParameters& airframe = settings.vehicle.airframe;
  const MotorLayout layout = layout_of(settings);
  // Its motors turn with 15 to 95 % of their full speed (MOT_SPIN_MIN, MOT_SPIN_MAX).
  constexpr double kSpinMin = 0.15, kSpinMax = 0.95;
  const double hover_speed =
      std::sqrt(airframe.mass_kg * settings.gravity_m_s2 / flight_limits(airframe).max_thrust_N);
  const double hover = std::max(0.0, hover_speed - kSpinMin) / (kSpinMax - kSpinMin);
  std::map<std::string, double> all = {
      {"FRAME_CLASS", layout.frame_class},
      {"FRAME_TYPE", layout.frame_type},
      {"MOT_THST_EXPO", 1.0},  // thrust grows with the square of the speed
      {"MOT_THST_HOVER", std::clamp(hover * hover, 0.125, 0.6875)},
      {"FS_THR_ENABLE", 0.0},  // there are no sticks
      {"SIM_BARO_RND", 0.0},   // as in its own simulations of multicopters
      // When the log is opened at arming, time goes on until a thread has opened it.
      {"LOG_DISARMED", 1.0},
      // Those of its simulated compasses.
      {"COMPASS_OFS_X", 5.0},
      {"COMPASS_OFS_Y", 13.0},
      {"COMPASS_OFS_Z", -18.0},
      {"COMPASS_OFS2_X", 5.0},
      {"COMPASS_OFS2_Y", 13.0},
      {"COMPASS_OFS2_Z", -18.0},
      {"COMPASS_OFS3_X", 5.0},
      {"COMPASS_OFS3_Y", 13.0},
      {"COMPASS_OFS3_Z", -18.0},
  };
  // Its main loop must not be faster than every second step of the simulation.
  constexpr Duration kForDefault = std::chrono::microseconds(1250);
  if (settings.period > kForDefault)
    all["SCHED_LOOP_RATE"] = std::floor(0.5 / to_seconds(settings.period));
  for (const auto& [name, value] : settings.parameters) all[name] = value;
  return all;
}

os::ChildCommand ardupilot_command(const ExternalSettings& settings, const UdpPort& simulator,
                                   const UdpPort& link) {
  constexpr const char* kProgram = "bin/arducopter";
  constexpr const char* kParameters = "tether.parm";
  prepare_folders(settings, {kProgram},
                  "the folder of ArduPilot's build for SITL with its target 'copter', such as "
                  "ardupilot/build/sitl");
  std::ofstream file(settings.folder / kParameters);
  for (const auto& [name, value] : ardupilot_parameters(settings))
    file << fmt::format("{} {:.9g}\n", name, value);
  const sim::Place& place = settings.place;
  return {.arguments = {(settings.build / kProgram).string(), "--model", "JSON:127.0.0.1",
                        // No sleep of its own.
                        "--speedup", "1000",
                        // 2026-01-01, the date of ET 0 of programs as they are, too.
                        "--start-time", "1767225600", "--home",
                        fmt::format("{:.9f},{:.9f},{:.3f},0", place.latitude_deg,
                                    place.longitude_deg, place.elevation_m),
                        "--defaults", kParameters, "--sysid", std::to_string(settings.instance + 1),
                        "--sim-port-out", std::to_string(simulator.number()), "--serial0",
                        fmt::format("udpclient:127.0.0.1:{}", link.number()),
                        // Nothing else listens, so that many can run.
                        "--serial1", "none:", "--serial2", "none:", "--rc-in-port", "0"},
          .environment = {},
          .log = settings.folder / "ardupilot.log",
          .working_folder = settings.folder};
}

class ArduPilot final : public ExternalController {
 public:
  explicit ArduPilot(const ExternalSettings& settings)
      : ArduPilot(settings, Ports{{0, "ArduPilot"}, {0, "ArduPilot"}}) {}

 private:
  struct Ports {
    UdpPort simulator, link;
  };
  ArduPilot(const ExternalSettings& settings, Ports&& ports)
      : ExternalController(settings, "ArduPilot", kOldestArduPilot, std::move(ports.link),
                           ardupilot_command(settings, ports.simulator, ports.link)),
        motors_(layout_of(settings).motors),
        simulator_(std::move(ports.simulator)) {
    try {
      await_servos();
    } catch (const Error& e) {
      throw Error(ErrorCode::kSetup,
                  fmt::format("{}. It has not begun: 'path' must be a build of ArduCopter that "
                              "knows the options with which it is started (tried with 4.7)",
                              e.what()));
    }
  }

  bool has_booted(Duration at) override {
    constexpr Duration kBetween = seconds(1);
    constexpr int kSystemStatus = 1, kEstimatorReport = 193, kRunPrearmChecks = 401;
    if (has_position_ && is_healthy_) return true;
    if (at > settings_.boot)
      throw Error(
          ErrorCode::kSetup,
          fmt::format("{} is not ready to arm after {:.0f} s of its time: {}. See its log, "
                      "{}; if it needs longer, increase 'boot_s'",
                      name_, to_seconds(settings_.boot),
                      is_healthy_ ? "its estimator has no position yet" : '"' + last_text_ + '"',
                      program_.log().string()));
    if (at / kBetween == (at - settings_.period) / kBetween) return false;
    for (const int message : {kVersionMessage, kSystemStatus, kEstimatorReport}) request(message);
    // Then it says what is wrong.
    if (at + 2 * kBetween > settings_.boot) command(kRunPrearmChecks);
    return false;
  }

  // What it has not read yet waits at its port.
  void pass_on(const std::vector<Bytes>& received) override {
    for (const Bytes& bytes : received) link_.send(bytes);
  }

  void advance(Duration at, const uav::BodyState& truth, const Readings& readings) override {
    const std::string state = json_state(at, settings_.place, truth, readings);
    simulator_.send({reinterpret_cast<const std::uint8_t*>(state.data()), state.size()});
    await_servos();
  }

  // While it waits, it sends the same servos again each second. They are never answered: it would
  // lag by a step from then on.
  void await_servos() {
    constexpr Duration kLimit = seconds(30), kLook = std::chrono::milliseconds(100);
    const auto now = [] { return os::read_clock(CLOCK_MONOTONIC); };
    const Duration began = now();
    const std::int64_t last = step_;
    while (step_ == last) {
      simulator_.wait(kLook);
      for (const Bytes& datagram : simulator_.receive()) take_servos(datagram);
      if (step_ != last) break;
      program_.require_alive();
      if (now() - began > kLimit)
        throw Error(ErrorCode::kHung,
                    fmt::format("{} has not answered for {:.0f} s of real time; see {}", name_,
                                to_seconds(kLimit), program_.log().string()));
    }
    serve_link();
  }

  void take_servos(const Bytes& datagram) {
    const auto servos = decode_servos(datagram);
    if (!servos)
      throw Error(ErrorCode::kSetup,
                  fmt::format("{} sends servos in a format that is not known ({} bytes). Use "
                              "ArduPilot 4.5 or later, with 16 servos (SERVO_32_ENABLE = 0)",
                              name_, datagram.size()));
    if (servos->step <= step_) return;
    step_ = servos->step;
    servos_ = *servos;
  }

  std::vector<double> rotor_shares() const override {
    std::vector<double> shares;
    for (const std::size_t motor : motors_) shares.push_back(share_of_pwm(servos_.pwm[motor]));
    return shares;
  }

  bool take(const mavlink::Message& m) override {
    constexpr std::int64_t kPrearmCheck = 0x1000'0000;  // MAV_SYS_STATUS_PREARM_CHECK
    constexpr std::int64_t kPositionInWorld = 0x10;     // EKF_POS_HORIZ_ABS
    if (m.is("SYS_STATUS"))
      is_healthy_ = (m.integer("onboard_control_sensors_health") & kPrearmCheck) != 0;
    if (m.is("EKF_STATUS_REPORT")) has_position_ = (m.integer("flags") & kPositionInWorld) != 0;
    if (m.is("STATUSTEXT")) last_text_ = m.text("text");
    return false;
  }

  std::vector<std::size_t> motors_;
  UdpPort simulator_;
  Servos servos_;
  std::int64_t step_ = -1;
  bool is_healthy_ = false, has_position_ = false;
  std::string last_text_ = "no text";
};

}  // namespace

std::unique_ptr<FlightController> start_ardupilot(const ExternalSettings& settings) {
  if (settings.period > kLongestStep)
    throw Error(ErrorCode::kSetup,
                fmt::format("ArduPilot does not fly with steps of {:.1f} ms. Choose a step of at "
                            "most 4 ms for the simulator",
                            1e3 * to_seconds(settings.period)));
  return std::make_unique<ArduPilot>(settings);
}

}  // namespace tether::autopilot
