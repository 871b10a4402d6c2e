#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include <tether/link/server.h>

namespace tether::link {

/// Keeps what a server reports, and lets a test react to messages.
struct RecordingEvents {
  struct Received {
    PeerId peer;
    Message message;
  };
  struct Lost {
    PeerId peer;
    Failure failure;
  };
  std::vector<PeerId> connected;
  std::vector<Received> received;
  std::map<PeerId, std::size_t> received_from;
  std::vector<Lost> closed;
  std::vector<PeerId> half_closed;
  std::function<void(PeerId, const Message&)> react;
  bool keeps_half_closed = false;

  /// Polls once; whether anything was reported.
  bool poll(Server& server, Duration max_wait) {
    const auto events = server.poll(max_wait);
    for (auto& [peer, what] : events) {
      if (std::holds_alternative<Connected>(what)) connected.push_back(peer);
      if (auto* message = std::get_if<Message>(&what)) {
        if (react) react(peer, *message);
        received.push_back({peer, std::move(*message)});
        ++received_from[peer];
      }
      if (const auto* end = std::get_if<Closed>(&what)) {
        if (end->may_still_read && keeps_half_closed) {
          half_closed.push_back(peer);
          continue;
        }
        closed.push_back({peer, end->failure});
        if (end->may_still_read) server.close(peer);
      }
    }
    return !events.empty();
  }
};

/// Polls until `done`; false if that takes longer than a test should.
inline bool poll_until(Server& server, RecordingEvents& events, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    events.poll(server, std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace tether::link
