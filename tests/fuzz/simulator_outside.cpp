#include "socket_connection.h"
#include "socket_pair.h"

/// The simulator's side, with a host that has said everything beforehand. Input: what it says.
namespace tether::fuzz {
namespace {

namespace protocol = sim::protocol;
using Kind = Failure::Kind;

/// What a request that is let through promises (Connection::receive_request).
class Promises {
 public:
  void check(const protocol::Request& request) {
    std::visit([this](const auto& r) { kept(r); }, request);
  }

 private:
  void kept(const protocol::Open& open) {
    require(!open_, "Open a second time");
    open_ = open;
  }
  void kept(const protocol::Reset&) {
    require(open_.has_value(), "Reset before Open");
    now_ = SimTime{};
  }
  void kept(const protocol::Advance& advance) {
    require(open_ && advance.to >= now_, "time goes back");
    require(open_->step.count() > 0 && to_ns(advance.to) % open_->step.count() == 0,
            "off the grid");
    for (const auto& command : advance.commands)
      require(
          command.uav < open_->uavs.size() && complaint_about(to_setpoint(command.command)).empty(),
          "a bad command");
    for (const auto& [uav, setpoint] : advance.setpoints)
      require(uav < open_->uavs.size() &&
                  complaint_about(setpoint, flight_limits(open_->uavs[uav].airframe)).empty(),
              "a bad set-point");
    now_ = advance.to;
  }
  void kept(const protocol::CastRays& cast) { require_bodies(cast.X_WB.size(), cast.carrier); }
  void kept(const protocol::Render& render) {
    require_bodies(render.X_WB.size(), render.hidden);
    require(render.camera.width_px <= open_->max_width_px &&
                render.camera.height_px <= open_->max_height_px,
            "a picture larger than announced");
  }
  void require_bodies(std::size_t poses, std::optional<std::uint32_t> one) {
    require(open_ && poses == open_->uavs.size() + open_->bodies.size(), "not a pose per body");
    require(!one || *one < poses, "a body that is none");
  }

  std::optional<protocol::Open> open_;
  SimTime now_;
};

void serve(protocol::Connection& connection, SpokenFor& host) {
  Promises promises;
  while (true) {
    const auto request = connection.receive_request();
    host.read_all();
    if (value_or_refused(request, {Kind::kProtocol, Kind::kDisconnected}) == nullptr) return;
    promises.check(*request);
    (void)connection.send(protocol::Reply(protocol::Failed{"no"}));
  }
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::SpokenFor host({data, size});
  const auto connection = sim::protocol::make_connection(host.take_ours(), "host");
  fuzz::serve(*connection, host);
  return 0;
}
