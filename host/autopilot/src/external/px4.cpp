// One step: what the companion has sent goes to PX4's port, and a TIMESYNC after it, whose answer
// shows that all of it was taken. Once PX4 rests, HIL_SENSOR gives it its new time; it computes
// until it has come to rest again. What it has sent meanwhile, it has sent at this step.

#include "external/held_program.h"
#include "external/hil.h"
#include "external/ports.h"
#include "set_down.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <tether/autopilot/px4.h>
#include <tether/base/error.h>
#include <tether/mavlink/frame.h>
#include <tether/os/clock.h>

namespace tether::autopilot {
namespace {

constexpr mavlink::Address kSimulator{.system = 255, .component = 190};
constexpr Duration kGpsPeriod = std::chrono::milliseconds(200);
constexpr int kSafetyArmed = 128;  // MAV_MODE_FLAG_SAFETY_ARMED

std::string text_of(double value) {
  return fmt::format("{:.9g}", value);
}

/// What PX4 must know of the vehicle: where its rotors are and how they turn, and what they can.
os::Environment parameters_of(const Px4Settings& settings) {
  const uav::MultirotorParameters& airframe = settings.vehicle.airframe;
  // PX4 takes a value that is its own default for none, and then that of the airframe's script.
  constexpr double kNoDefault = 1e-5;
  const double most_N = airframe.thrust_coefficient * airframe.max_rotor_speed_rad_s *
                        airframe.max_rotor_speed_rad_s *
                        static_cast<double>(airframe.rotors.size());
  std::map<std::string, std::string> all = {
      {"CA_ROTOR_COUNT", std::to_string(airframe.rotors.size())},
      {"THR_MDL_FAC", "1"},  // thrust grows with the square of the speed
      {"MPC_THR_HOVER",
       text_of(std::clamp(airframe.mass_kg * settings.gravity_m_s2 / most_N, 0.1, 0.8))}};
  for (std::size_t i = 0; i < airframe.rotors.size(); ++i) {
    const uav::Rotor& rotor = airframe.rotors[i];
    all[fmt::format("CA_ROTOR{}_PX", i)] = text_of(rotor.p_BR.x + kNoDefault);
    all[fmt::format("CA_ROTOR{}_PY", i)] = text_of(-rotor.p_BR.y + kNoDefault);
    all[fmt::format("CA_ROTOR{}_KM", i)] =
        text_of(rotor.direction * airframe.moment_coefficient_m + kNoDefault);
    all[fmt::format("PWM_MAIN_FUNC{}", i + 1)] = std::to_string(101 + i);
  }
  for (const auto& [name, value] : settings.parameters) all[name] = text_of(value);
  os::Environment environment = {{"PX4_SIM_MODEL", "none_iris"}};
  for (const auto& [name, value] : all) environment.emplace_back("PX4_PARAM_" + name, value);
  return environment;
}

os::ChildCommand command_of(const Px4Settings& settings) {
  const std::filesystem::path program = settings.build / "bin/px4", files = settings.build / "etc";
  std::error_code none;
  for (const std::filesystem::path& needed : {program, files})
    if (!std::filesystem::exists(needed, none))
      throw Error(ErrorCode::kSetup, {settings.build.string()},
                  "has no " + needed.lexically_relative(settings.build).string() +
                      ". 'path' must be the folder of PX4's build for its software in the loop, "
                      "such as PX4-Autopilot/build/px4_sitl_default.")
          .about(settings.build.string());
  std::filesystem::remove_all(settings.folder, none);
  std::filesystem::create_directories(settings.folder, none);
  return {.arguments = {program.string(), "-d", "-i", std::to_string(settings.instance),
                        files.string()},
          .environment = parameters_of(settings),
          .log = settings.folder / "px4.log",
          .working_folder = settings.folder};
}

const sim::Sensor* sensor_of(const sim::Uav& vehicle, uav::SensorKind kind) {
  const auto found = std::ranges::find(vehicle.sensors, kind, &sim::Sensor::kind);
  return found == vehicle.sensors.end() ? nullptr : &*found;
}

class Px4 : public FlightController {
 public:
  explicit Px4(const Px4Settings& settings)
      : settings_(settings),
        ports_(settings.instance),
        program_("PX4 of UAV '" + settings.vehicle.name + "'", command_of(settings)) {
    connect();
    boot();
  }

  Actions step(const Sensed& sensed, const std::vector<Bytes>& received) override {
    Actions actions;
    const auto pass_on = [&] {
      for (const Bytes& bytes : received) ports_.send_datagram(bytes);
      fence();
    };
    // What it does with them, it does before its time goes on.
    if (!received.empty()) program_.let_rest(pass_on, [this] { serve(); });
    advance(settings_.boot + sensed.at.time_since_epoch(), readings_of(sensed));
    is_set_down_ = is_set_down_ || set_down_.is_done(sensed.at, sensed.truth);
    actions.setpoint = is_set_down_ ? rotors() : SetDown::setpoint();
    actions.sent = std::exchange(sent_, {});
    return actions;
  }

  std::string version() const override { return version_; }

 private:
  void connect() {
    constexpr Duration kLimit = std::chrono::seconds(30);
    constexpr Duration kBetween = std::chrono::milliseconds(1);
    const Duration began = os::read_clock(CLOCK_MONOTONIC);
    for (Duration now = began; !ports_.accept(); now = os::read_clock(CLOCK_MONOTONIC)) {
      program_.require_alive();
      if (now - began > kLimit)
        throw Error(
            ErrorCode::kSetup,
            fmt::format("PX4 has not connected to the simulator's port {} within 30 s; see "
                        "{}",
                        ports_.numbers().simulator, (settings_.folder / "px4.log").string()));
      os::sleep_until(now + kBetween);
    }
  }

  // On the ground, where nothing moves.
  void boot() {
    const uav::BodyState truth{settings_.vehicle.X_WB.p, settings_.vehicle.X_WB.q, {}, {}};
    const uav::Vec3 at_rest_B =
        rotate(inverse(truth.q_WB), uav::Vec3{0.0, 0.0, settings_.gravity_m_s2});
    const Readings still =
        ideal_readings(truth, at_rest_B, settings_.place, settings_.magnetic_field_T);
    constexpr Duration kForVersion = std::chrono::seconds(2);
    for (Duration at = kPx4Period; at < settings_.boot; at += kPx4Period) {
      if (at == settings_.boot - kForVersion) ask_version();
      advance(at, still);
    }
    sent_.clear();  // nobody was there
  }

  void ask_version() {
    // MAV_CMD_REQUEST_MESSAGE of AUTOPILOT_VERSION
    constexpr int kCommand = 512, kWanted = 148;
    send(mavlink::Message("COMMAND_LONG")
             .set("command", kCommand)
             .set("param1", kWanted)
             .set("target_system", settings_.instance + 1)
             .set("target_component", 1));
    fence();
  }

  /// One step of PX4's own time.
  void advance(Duration at, const Readings& exact) {
    const Readings readings =
        with_noise(exact, settings_.seed, static_cast<std::uint64_t>(at / kPx4Period));
    const auto send = [&] {
      std::vector<std::uint8_t> bytes;  // sent at once, so that they wake it once
      const auto add = [&](const mavlink::Message& message) {
        const auto frame = mavlink::encode(message, kSimulator, sequence_++);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
      };
      if (std::exchange(gps_, at / kGpsPeriod) != at / kGpsPeriod)
        add(hil_gps(at, readings.position));
      add(hil_sensor(at, readings));
      ports_.send_stream(bytes);
      // Its actuators come late in its step. During the boot, none do.
      constexpr Duration kWait = std::chrono::seconds(1);
      if (std::exchange(has_sent_controls_, false)) ports_.wait_for_stream(kWait);
    };
    program_.let_rest(send, [this] { serve(); });
  }

  // Takes what PX4 sends, so that its buffers are never full.
  void serve() {
    for (mavlink::Frame& frame : decoder_.push(ports_.receive_stream()))
      if (frame.message.is("HIL_ACTUATOR_CONTROLS")) {
        controls_ = std::move(frame.message);
        has_sent_controls_ = true;
      }
    for (Bytes& datagram : ports_.receive_datagrams()) take(std::move(datagram));
  }

  void take(Bytes datagram) {
    const auto frames = mavlink::Decoder().push_datagram(datagram);
    for (const mavlink::Frame& frame : frames) {
      const mavlink::Message& m = frame.message;
      if (m.is("TIMESYNC") && m.integer("ts1") == fence_ && m.integer("tc1") != 0) {
        has_answered_ = true;
        if (frames.size() == 1) return;
      }
      if (m.is("AUTOPILOT_VERSION")) {
        constexpr unsigned kMajor = 24, kMinor = 16, kPatch = 8, kByte = 0xff;
        const auto number = static_cast<std::uint32_t>(m.integer("flight_sw_version"));
        version_ = fmt::format("{}.{}.{}", number >> kMajor, (number >> kMinor) & kByte,
                               (number >> kPatch) & kByte);
      }
    }
    sent_.push_back(std::move(datagram));
  }

  void send(const mavlink::Message& message) {
    ports_.send_datagram(mavlink::encode(message, kSimulator, sequence_++));
  }

  /// Waits until PX4 has taken all datagrams that were sent to it.
  void fence() {
    constexpr Duration kWait = std::chrono::milliseconds(1), kLimit = std::chrono::seconds(5);
    has_answered_ = false;
    send(mavlink::Message("TIMESYNC").set("tc1", 0).set("ts1", ++fence_));
    for (Duration waited{0}; !has_answered_ && waited < kLimit; waited += kWait) {
      ports_.wait_for_datagram(kWait);
      serve();
      program_.require_alive();
    }
  }

  Readings readings_of(const Sensed& sensed) {
    const auto* imu = sensor_of(settings_.vehicle, uav::SensorKind::kImu);
    const auto* compass = sensor_of(settings_.vehicle, uav::SensorKind::kMagnetometer);
    const auto measured = std::get<uav::ImuSample>(*sensed.measure(uav::SensorKind::kImu));
    Readings readings =
        ideal_readings(sensed.truth, rotate(imu->X_BS.q, measured.specific_force_m_s2),
                       settings_.place, settings_.magnetic_field_T);
    readings.w_WB_B_rad_s = rotate(imu->X_BS.q, measured.angular_velocity_rad_s);
    if (const auto sample = sensed.measure(uav::SensorKind::kMagnetometer))
      readings.field_B_T =
          rotate(compass->X_BS.q, std::get<uav::MagnetometerSample>(*sample).field_T);
    if (const auto sample = sensed.measure(uav::SensorKind::kBarometer))
      readings.pressure_Pa = std::get<uav::BarometerSample>(*sample).pressure_Pa;
    if (const auto sample = sensed.measure(uav::SensorKind::kNavSat))
      readings.position = std::get<uav::NavSatSample>(*sample);
    return readings;
  }

  uav::Setpoint rotors() const {
    const uav::MultirotorParameters& airframe = settings_.vehicle.airframe;
    uav::Setpoint setpoint;
    setpoint.mask = uav::kRotorSpeeds;
    const bool is_armed = controls_ && (controls_->integer("mode") & kSafetyArmed) != 0;
    setpoint.rotor_speeds_rad_s = is_armed ? rotor_speeds_rad_s(*controls_, airframe.rotors.size(),
                                                                airframe.max_rotor_speed_rad_s)
                                           : std::vector<double>(airframe.rotors.size(), 0.0);
    return setpoint;
  }

  Px4Settings settings_;
  Ports ports_;
  HeldProgram program_;
  mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  std::optional<mavlink::Message> controls_;
  bool has_sent_controls_ = false;  ///< in the newest step
  std::vector<Bytes> sent_;
  std::int64_t gps_ = 0;  ///< number of the last fix
  std::int64_t fence_ = 0;
  bool has_answered_ = false;
  std::string version_;
  SetDown set_down_;
  bool is_set_down_ = false;
};

}  // namespace

std::unique_ptr<FlightController> start_px4(const Px4Settings& settings) {
  if (sensor_of(settings.vehicle, uav::SensorKind::kImu) == nullptr)
    throw Error(ErrorCode::kSetup, "PX4 needs an IMU, and the UAV '" + settings.vehicle.name +
                                       "' has none. Add one to its model");
  return std::make_unique<Px4>(settings);
}

bool is_px4_parameter(const std::string& name) {
  constexpr std::size_t kLongest = 16;
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace tether::autopilot
