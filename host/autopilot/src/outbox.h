#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {

/// What the controller sends in a step.
class Outbox {
 public:
  explicit Outbox(mavlink::Address own) : own_(own) {}

  mavlink::Address own() const { return own_; }
  void send(const mavlink::Message& message) {
    frames_.push_back(mavlink::encode(message, own_, sequence_++));
  }
  /// A line for the user. MAVLink's severities: 2 critical, 4 warning, 6 information.
  void say(int severity, std::string_view text) {
    send(mavlink::Message("STATUSTEXT").set("severity", severity).set_text("text", text));
  }
  std::vector<Bytes> take() { return std::exchange(frames_, {}); }

 private:
  mavlink::Address own_;
  std::uint8_t sequence_ = 0;
  std::vector<Bytes> frames_;
};

}  // namespace tether::autopilot
