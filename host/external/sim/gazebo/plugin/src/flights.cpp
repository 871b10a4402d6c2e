#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {

Flights::Flights(const sim::protocol::Open& open) : gravity_m_s2_(open.gravity_m_s2) {
  for (const sim::protocol::UavDescription& uav : open.uavs) {
    flights_.push_back(
        {{uav.airframe, gravity_m_s2_, open.step}, uav::yaw_rad(uav.X_WB.q), {}, {}});
  }
  reset();
}

void Flights::reset() {
  for (Flight& flight : flights_) {
    flight.setpoint = {};
    flight.state =
        uav::hover_state(flight.multirotor.parameters(), gravity_m_s2_, flight.start_yaw_rad);
  }
}

void Flights::set_setpoint(std::size_t uav, const uav::Setpoint& setpoint) {
  flights_[uav].setpoint = setpoint;
}

uav::Wrench Flights::step(std::size_t uav, const uav::BodyState& body) {
  Flight& flight = flights_[uav];
  return flight.multirotor.step(body, flight.setpoint, flight.state);
}

}  // namespace tether::gazebo_plugin
