// A companion of a flight controller: companion_sut [COMPUTE_MS] [SIDE_M] [GIMBAL_DEG]
//
// Arms, takes off, flies a square with position set-points at 20 Hz, and lands. Before each
// set-point it computes for so long. In the air, it points the gimbal down by that angle. Its end
// has how far it was from the corners, and what its messages told.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <tether/client/simulated_vehicle.h>
#include <tether/mavlink/frame.h>

namespace {

using std::chrono::milliseconds;
using tether::Duration;
using tether::mavlink::Message;

template <class T>
T require(tether::Result<T> result) {
  if (result) return std::move(result).value();
  std::fprintf(stderr, "companion_sut: %s\n", result.failure().message.c_str());
  std::_Exit(3);
}

constexpr const char* kAutopilot = "autopilot";

class Companion {
 public:
  explicit Companion(tether::client::Vehicle& vehicle) : vehicle_(vehicle) {}

  void send(const Message& message) {
    require(
        vehicle_.send(kAutopilot, tether::mavlink::encode(message, {system_, 191}, sequence_++)));
  }

  // Takes what arrives until then.
  void listen(Duration duration) {
    const auto until = vehicle_.now() + duration;
    while (auto message = vehicle_.receive(std::max(Duration(0), until - vehicle_.now())))
      for (const auto& frame : decoder_.push(message->bytes)) {
        system_ = frame.from.system;
        on_message(frame.message);
      }
  }

  void command(int id, double p1 = 0, double p2 = 0, double p3 = 0, double p7 = NAN) {
    ack.reset();
    send(Message("COMMAND_LONG")
             .set("target_system", system_)
             .set("target_component", 1)
             .set("command", id)
             .set("param1", p1)
             .set("param2", p2)
             .set("param3", p3)
             .set("param4", NAN)
             .set("param5", NAN)
             .set("param6", NAN)
             .set("param7", p7));
    while (!ack) listen(milliseconds(1));
    if (*ack != 0) fail("command " + std::to_string(id) + " gave " + std::to_string(*ack));
  }

  void position(double x, double y, double z) {
    send(Message("SET_POSITION_TARGET_LOCAL_NED")
             .set("target_system", system_)
             .set("target_component", 1)
             .set("coordinate_frame", 1)
             .set("type_mask", 0x0DF8)
             .set("x", x)
             .set("y", y)
             .set("z", z));
  }

  double distance(double x, double y, double z) const {
    return std::hypot(p[0] - x, p[1] - y, p[2] - z);
  }

  [[noreturn]] void fail(const std::string& why) {
    require(vehicle_.finish(false, why, "{}"));
    std::_Exit(1);
  }

  double p[3] = {};
  std::optional<long> ack;
  bool is_armed = false;
  bool is_landed = true;
  unsigned long messages = 0;
  std::string said;

 private:
  void on_message(const Message& m) {
    ++messages;
    if (m.is("COMMAND_ACK")) ack = m.integer("result");
    if (m.is("HEARTBEAT")) is_armed = (m.integer("base_mode") & 128) != 0;
    if (m.is("EXTENDED_SYS_STATE")) is_landed = m.integer("landed_state") == 1;
    if (m.is("STATUSTEXT")) said += m.text("text") + "; ";
    if (m.is("LOCAL_POSITION_NED"))
      for (std::size_t i = 0; i < 3; ++i) p[i] = m.number(std::string(1, "xyz"[i]));
  }

  tether::client::Vehicle& vehicle_;
  tether::mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  std::uint8_t system_ = 1;
};

void compute(int ms) {
  const auto until = std::chrono::steady_clock::now() + milliseconds(ms);
  while (std::chrono::steady_clock::now() < until) {
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int compute_ms = argc > 1 ? std::atoi(argv[1]) : 0;
  const double side = argc > 2 ? std::atof(argv[2]) : 1.0;
  const double gimbal_deg = argc > 3 ? std::atof(argv[3]) : 0.0;
  const auto vehicle =
      require(tether::client::connect(require(tether::client::options_from_environment())));
  Companion companion(*vehicle);
  constexpr double kHeight = 1.2;
  companion.listen(milliseconds(1500));
  companion.command(400, 1);
  companion.command(22);
  while (companion.p[2] > -kHeight) companion.listen(milliseconds(20));
  const auto fly = [&](double x, double y, double seconds) {
    const auto until = vehicle->now() + tether::duration_from_seconds(seconds);
    while (vehicle->now() < until) {
      compute(compute_ms);
      companion.position(x, y, -kHeight);
      companion.listen(milliseconds(50));
    }
  };
  constexpr int kMountControl = 205, kByAngles = 2;
  if (gimbal_deg != 0.0) companion.command(kMountControl, -gimbal_deg, 0, 0, kByAngles);
  fly(0, 0, 1.5);
  companion.command(176, 1, 6);
  std::string errors;
  for (const auto& [x, y] : {std::pair{side, 0.0}, {side, side}, {0.0, side}, {0.0, 0.0}}) {
    fly(x, y, 4.0);
    errors += (errors.empty() ? "" : ", ") + std::to_string(companion.distance(x, y, -kHeight));
  }
  companion.command(21);
  while (companion.is_armed) companion.listen(milliseconds(100));
  require(vehicle->finish(true, "landed",
                          "{\"errors_m\": [" + errors +
                              "], \"messages\": " + std::to_string(companion.messages) +
                              ", \"said\": \"" + companion.said + "\"}"));
}
