#include "external/ports.h"

#include <utility>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

class WithGroundStation final : public FlightController {
 public:
  WithGroundStation(std::unique_ptr<FlightController> controller, bool may_command,
                    std::uint16_t port)
      : controller_(std::move(controller)), may_command_(may_command) {
    station_.set_peer(port);
  }

  void boot(const Sensed& at_rest) override { controller_->boot(at_rest); }

  Actions step(const Sensed& sensed, const std::vector<Bytes>& received) override {
    // A station that sends without end must not hold the run.
    constexpr std::size_t kMostOfAStep = 64;
    std::vector<Bytes> of_station = station_.receive(kMostOfAStep);
    if (!may_command_)
      for (const Bytes& bytes : std::exchange(of_station, {})) deny(bytes);
    std::vector<Bytes> all = received;
    all.insert(all.end(), of_station.begin(), of_station.end());
    Actions actions = controller_->step(sensed, all);
    actions.of_station = std::move(of_station);
    for (const Bytes& bytes : actions.sent) station_.send(bytes);
    return actions;
  }

  std::string version() const override { return controller_->version(); }

 private:
  void deny(const Bytes& bytes) {
    constexpr int kRefused = 2;  // MAV_RESULT_DENIED
    for (const mavlink::Frame& frame : mavlink::Decoder().push_datagram(bytes)) {
      const mavlink::Message& m = frame.message;
      if (!m.is("COMMAND_LONG") && !m.is("COMMAND_INT")) continue;
      const mavlink::Address from{static_cast<std::uint8_t>(m.integer("target_system")), 1};
      station_.send(mavlink::encode(mavlink::Message("COMMAND_ACK")
                                        .set("command", m.integer("command"))
                                        .set("result", kRefused)
                                        .set("target_system", frame.from.system)
                                        .set("target_component", frame.from.component),
                                    from, sequence_++));
    }
  }

  std::unique_ptr<FlightController> controller_;
  bool may_command_;
  UdpPort station_{0, "the ground station"};
  std::uint8_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<FlightController> with_ground_station(std::unique_ptr<FlightController> controller,
                                                      GroundStation what, std::uint16_t port) {
  if (what == GroundStation::kAbsent) return controller;
  return std::make_unique<WithGroundStation>(std::move(controller),
                                             what == GroundStation::kCommands, port);
}

}  // namespace tether::autopilot
