// One step: what the companion has sent goes to PX4's port, and a TIMESYNC after it, whose answer
// shows that all of it was taken. Once PX4 rests, HIL_SENSOR gives it its new time; it computes
// until it has come to rest again. What it has sent meanwhile, it has sent at this step.

#include "external/external_controller.h"
#include "external/hil.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/mavlink/frame.h>
#include <tether/os/machine.h>

namespace tether::autopilot {
namespace {

// It takes the airframe as parameters of its environment.
constexpr Version kOldestPx4 = {1, 14, 0};
constexpr Duration kGpsPeriod = std::chrono::milliseconds(200);
constexpr int kSafetyArmed = 128;  // MAV_MODE_FLAG_SAFETY_ARMED

// Of its first instance; those of the others follow.
enum Port : int {
  kSimulatorPort = 4560,   // TCP: PX4 connects to it
  kCompanionPort = 14540,  // UDP: PX4 sends to it …
  kOwnPort = 14580,        // … and listens here
};
// Where PX4 would listen to others: a ground station, a payload and a gimbal.
constexpr int kOtherPorts[] = {18570, 14280, 13030};
std::uint16_t number(int port, const ExternalSettings& settings) {
  return static_cast<std::uint16_t>(port + settings.instance);
}

std::string text_of(double value) {
  return fmt::format("{:.9g}", value);
}

/// What PX4 must know of the vehicle: where its rotors are and how they turn, and what they can.
os::Environment px4_environment(const ExternalSettings& settings) {
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

os::ChildCommand px4_command(const ExternalSettings& settings) {
  prepare_folders(settings, {"bin/px4", "etc"},
                  "the folder of PX4's build for its software in the loop, such as "
                  "PX4-Autopilot/build/px4_sitl_default");
  return {.arguments = {(settings.build / "bin/px4").string(), "-d", "-i",
                        std::to_string(settings.instance), (settings.build / "etc").string()},
          .environment = px4_environment(settings),
          .log = settings.folder / "px4.log",
          .working_folder = settings.folder};
}

class Px4 final : public ExternalController {
 public:
  explicit Px4(const ExternalSettings& settings)
      : Px4(settings, Ports{{number(kSimulatorPort, settings), "PX4"},
                            {number(kCompanionPort, settings), "PX4"},
                            closed_ports(settings)}) {}

 private:
  struct Ports {
    TcpPort simulator;
    UdpPort companion;
    std::vector<UdpPort> closed;
  };
  // Only its companion can command it, and a ground station by way of this process.
  static std::vector<UdpPort> closed_ports(const ExternalSettings& settings) {
    std::vector<UdpPort> ports;
    for (const int port : kOtherPorts) ports.emplace_back(number(port, settings), "PX4");
    return ports;
  }
  Px4(const ExternalSettings& settings, Ports&& ports)
      : ExternalController(settings, "PX4", kOldestPx4, std::move(ports.companion),
                           px4_command(settings)),
        simulator_(std::move(ports.simulator)),
        closed_(std::move(ports.closed)) {
    link_.set_peer(number(kOwnPort, settings));
    connect();
  }

  void connect() {
    constexpr Duration kLimit = std::chrono::seconds(30);
    constexpr Duration kBetween = std::chrono::milliseconds(1);
    const Duration began = os::read_clock(CLOCK_MONOTONIC);
    for (Duration now = began; !simulator_.accept(); now = os::read_clock(CLOCK_MONOTONIC)) {
      program_.require_alive();
      if (now - began > kLimit)
        throw Error(ErrorCode::kSetup,
                    fmt::format("{} has not connected to the simulator's port {} within 30 s; see "
                                "{}",
                                name_, simulator_.number(), program_.log().string()));
      os::sleep_until(now + kBetween);
    }
  }

  bool has_booted(Duration at) override {
    constexpr Duration kForVersion = std::chrono::seconds(2);
    if (at >= settings_.boot - kForVersion && !std::exchange(has_asked_, true)) {
      request(kVersionMessage);
      fence();
    }
    return at >= settings_.boot;
  }

  // What it does with them, it does before its time goes on.
  void pass_on(const std::vector<Bytes>& received) override {
    const auto send = [&] {
      for (const Bytes& bytes : received) link_.send(bytes);
      fence();
    };
    program_.let_rest(send, [this] { serve(); });
  }

  void advance(Duration at, const uav::BodyState&, const Readings& exact) override {
    const Readings readings =
        with_noise(exact, settings_.seed, static_cast<std::uint64_t>(at / settings_.period));
    const auto send = [&] {
      std::vector<std::uint8_t> bytes;  // sent at once, so that they wake it once
      const auto add = [&](const mavlink::Message& message) {
        const auto frame = mavlink::encode(message, kSimulator, sequence_++);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
      };
      if (std::exchange(gps_, at / kGpsPeriod) != at / kGpsPeriod)
        add(hil_gps(at, readings.position));
      add(hil_sensor(at, readings));
      simulator_.send(bytes);
      // Its actuators come late in its step. During the boot, none do.
      constexpr Duration kWait = std::chrono::seconds(1);
      if (std::exchange(has_sent_controls_, false)) simulator_.wait(kWait);
    };
    program_.let_rest(send, [this] { serve(); });
    // Between messages, its receiver looks each 10 ms of real time whether an item of a mission, a
    // parameter or a file is to be sent. So that it looks at each step, it gets a message.
    if (has_spoken_) program_.let_rest([this] { fence(); }, [this] { serve(); });
  }

  std::vector<double> rotor_shares() const override {
    const std::size_t rotors = settings_.vehicle.airframe.rotors.size();
    const bool is_armed = controls_ && (controls_->integer("mode") & kSafetyArmed) != 0;
    return is_armed ? autopilot::rotor_shares(*controls_, rotors)
                    : std::vector<double>(rotors, 0.0);
  }

  bool take(const mavlink::Message& m) override {
    has_spoken_ = true;
    const bool is_answer = m.is("TIMESYNC") && m.integer("ts1") == fence_ && m.integer("tc1") != 0;
    has_answered_ = has_answered_ || is_answer;
    return is_answer;
  }

  // Takes what PX4 sends, so that its buffers are never full.
  void serve() {
    for (mavlink::Frame& frame : decoder_.push(simulator_.receive()))
      if (frame.message.is("HIL_ACTUATOR_CONTROLS")) {
        controls_ = frame.message;
        has_sent_controls_ = true;
      }
    serve_link();
  }

  /// Waits until PX4 has taken all datagrams that were sent to it.
  void fence() {
    constexpr Duration kWait = std::chrono::milliseconds(1), kLimit = std::chrono::seconds(5);
    has_answered_ = false;
    send(mavlink::Message("TIMESYNC").set("tc1", 0).set("ts1", ++fence_));
    for (Duration waited{0}; !has_answered_ && waited < kLimit; waited += kWait) {
      link_.wait(kWait);
      serve();
      program_.require_alive();
    }
  }

  TcpPort simulator_;
  std::vector<UdpPort> closed_;
  mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  std::optional<mavlink::Message> controls_;
  bool has_sent_controls_ = false;  ///< in the newest step
  std::int64_t gps_ = 0;            ///< number of the last fix
  std::int64_t fence_ = 0;
  bool has_answered_ = false;
  bool has_asked_ = false;   ///< for its version
  bool has_spoken_ = false;  ///< its link to the companion is open
};

}  // namespace

std::unique_ptr<FlightController> start_px4(const ExternalSettings& settings) {
  (void)UdpPort(number(kOwnPort, settings), "PX4");  // it binds this itself
  return std::make_unique<Px4>(settings);
}

}  // namespace tether::autopilot
