// The rules of a conversation beyond single messages: `note` keeps what the reply to a request must
// match, `complaint` compares a request or reply with it.

#include "conversation.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

namespace tether::sim::protocol {
namespace {

std::string number(std::size_t n) {
  return std::to_string(n);
}
std::string in_ns(SimTime t) {
  return std::to_string(to_ns(t)) + " ns";
}
std::string size(std::int32_t width_px, std::int32_t height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

/// "State.bodies has 2 entries instead of 3"; empty if there are as many as expected.
std::string unlike(const std::string& field, std::size_t is, std::size_t expected) {
  if (is == expected) return {};
  return field + " has " + number(is) + " entries instead of " + number(expected);
}

template <class Message, class Complain>
Status status_of(const Message& message, Complain complain) {
  const std::string complaint = std::visit(complain, message);
  if (complaint.empty()) return ok_status();
  return Failure{Failure::Kind::kProtocol, complaint};
}

}  // namespace

// --- requests -----------------------------------------------------------------------------------

Status Conversation::check(const Request& request) const {
  if (!is_open_ && !std::holds_alternative<Open>(request)) {
    return Failure{Failure::Kind::kProtocol, "the first request must be Open"};
  }
  return status_of(request, [this](const auto& r) { return complaint(r); });
}

std::string Conversation::complaint(const Open& open) const {
  if (is_open_) return "Open was received twice";
  if (open.version == kVersion) return {};
  return "the host uses version " + std::to_string(open.version) +
         " of the simulator protocol, the simulator version " + std::to_string(kVersion) +
         "; build both from the same release";
}

std::string Conversation::complaint(const Advance& advance) const {
  if (advance.to < now_) return "Advance.to is " + in_ns(advance.to) + ", before " + in_ns(now_);
  if (to_ns(advance.to) % step_.count() != 0) {
    return "Advance.to is " + in_ns(advance.to) + ", which is not a step boundary";
  }
  for (const Command& command : advance.commands) {
    if (command.uav >= uavs_.size()) {
      return "Advance.commands have the unknown UAV index " + number(command.uav);
    }
  }
  for (const auto& [uav, setpoint] : advance.setpoints) {
    if (uav >= uavs_.size()) return "Advance.setpoints have the unknown UAV index " + number(uav);
    if (const std::string wrong = complaint_about(setpoint, uavs_[uav]); !wrong.empty())
      return "Advance.setpoints: " + wrong;
  }
  return {};
}

std::string Conversation::complaint(const CastRays& cast) const {
  return unlike("CastRays.X_WB", cast.X_WB.size(), bodies_);
}

std::string Conversation::complaint(const Render& render) const {
  const uav::CameraModel& camera = render.camera;
  if (camera.width_px > max_width_px_ || camera.height_px > max_height_px_) {
    return "Render requests " + size(camera.width_px, camera.height_px) +
           " pixels; Open announced at most " + size(max_width_px_, max_height_px_);
  }
  return unlike("Render.X_WB", render.X_WB.size(), bodies_);
}

void Conversation::ask(const Request& request) {
  opening_ = false;
  std::visit([this](const auto& r) { note(r); }, request);
}

void Conversation::note(const Open& open) {
  is_open_ = opening_ = true;
  step_ = std::max(open.step, Duration(1));
  uavs_.clear();
  for (const UavDescription& uav : open.uavs) uavs_.push_back(flight_limits(uav.airframe));
  bodies_ = uavs_.size() + open.bodies.size();
  past_steps_ = open.past_steps;
  max_width_px_ = open.max_width_px;
  max_height_px_ = open.max_height_px;
  now_ = SimTime{};
  asked_ = ForState{now_, now_, 0};
}
void Conversation::note(const Reset&) {
  now_ = SimTime{};
  asked_ = ForState{now_, now_, 0};
}
void Conversation::note(const Advance& advance) {
  const auto steps = static_cast<std::size_t>((advance.to - now_) / step_);
  const SimTime from = std::exchange(now_, advance.to);
  asked_ = ForState{from, now_, std::min(steps, past_steps_) * bodies_};
}
void Conversation::note(const CastRays& cast) {
  asked_ = ForRays{cast.rays_S.size()};
}
void Conversation::note(const Render& render) {
  asked_ = ForPicture{render.camera.width_px, render.camera.height_px, render.with_depth};
}

// --- replies ------------------------------------------------------------------------------------

Status Conversation::check(const Reply& reply) const {
  return status_of(reply, [this](const auto& r) { return complaint(r); });
}

std::string Conversation::complaint(const Opened& opened) const {
  if (!opening_) return "Opened is not the reply to this request";
  return complaint_of_state(opened.state, *asked<ForState>());
}

std::string Conversation::complaint(const State& state) const {
  const auto* request = asked<ForState>();
  if (request == nullptr || opening_) return "State is not the reply to this request";
  return complaint_of_state(state, *request);
}

std::string Conversation::complaint_of_state(const State& state, const ForState& asked) const {
  if (state.now != asked.to) {
    return "State.now is " + in_ns(state.now) + " instead of " + in_ns(asked.to);
  }
  for (const std::string& wrong : {unlike("State.bodies", state.bodies.size(), bodies_),
                                   unlike("State.motions", state.motions.size(), uavs_.size()),
                                   unlike("State.past", state.past.size(), asked.past)}) {
    if (!wrong.empty()) return wrong;
  }
  SimTime before = asked.from;
  for (const Touch& touch : state.touches) {
    if (touch.uav >= uavs_.size())
      return "State.touches have the unknown UAV index " + number(touch.uav);
    if (touch.at < before || touch.at > asked.to || to_ns(touch.at) % step_.count() != 0) {
      return "State.touches have one at " + in_ns(touch.at) +
             ", which is not a step boundary of the advance, in order";
    }
    before = touch.at;
  }
  return {};
}

std::string Conversation::complaint(const Distances& distances) const {
  const auto* request = asked<ForRays>();
  if (request == nullptr) return "Distances is not the reply to this request";
  return unlike("Distances.distance_m", distances.distance_m.size(), request->count);
}

std::string Conversation::complaint(const Picture& picture) const {
  const auto* request = asked<ForPicture>();
  if (request == nullptr) return "Picture is not the reply to this request";
  if (picture.width_px != request->width_px || picture.height_px != request->height_px) {
    return "Picture has " + size(picture.width_px, picture.height_px) + " pixels instead of " +
           size(request->width_px, request->height_px);
  }
  if (request->with_depth && picture.nearest_depth_m <= 0.0) {
    return "Picture.nearest_depth_m is missing";
  }
  return {};
}

}  // namespace tether::sim::protocol
