#pragma once

#include <cstddef>
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
  /// A line for the user. MAVLink's severities: 2 critical, 4 warning, 6 information. A longer one
  /// than a message has room for is sent in pieces, of which the last one is not full.
  void say(int severity, std::string_view text) {
    constexpr std::size_t kPiece = 50;
    const int id = text.size() > kPiece ? ++last_text_ : 0;
    for (std::size_t piece = 0; piece <= text.size() / kPiece; ++piece) {
      if (id == 0 && piece > 0) return;
      send(mavlink::Message("STATUSTEXT")
               .set("severity", severity)
               .set_text("text", text.substr(piece * kPiece, kPiece))
               .set("id", id)
               .set("chunk_seq", piece));
    }
  }
  std::vector<Bytes> take() { return std::exchange(frames_, {}); }

 private:
  mavlink::Address own_;
  std::uint8_t sequence_ = 0;
  std::uint16_t last_text_ = 0;
  std::vector<Bytes> frames_;
};

}  // namespace tether::autopilot
