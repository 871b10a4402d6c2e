#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <tether/link/server.h>

namespace tether::link {

/// Keeps what a server reports, and lets a test react to messages.
struct RecordingEvents final : ServerEvents {
  struct Received {
    PeerId peer;
    Message message;
  };
  struct Closed {
    PeerId peer;
    Failure failure;
  };
  std::vector<PeerId> connected;
  std::vector<Received> received;
  std::vector<Closed> closed;
  std::vector<PeerId> half_closed;
  std::function<void(PeerId, const Message&)> react;
  bool keeps_half_closed = false;

  void on_connected(PeerId peer, const std::string&) override { connected.push_back(peer); }
  void on_message(PeerId peer, Message message) override {
    if (react) react(peer, message);
    received.push_back({peer, std::move(message)});
  }
  bool on_half_closed(PeerId peer) override {
    half_closed.push_back(peer);
    return keeps_half_closed;
  }
  void on_closed(PeerId peer, const Failure& failure) override {
    closed.push_back({peer, failure});
  }
};

/// Polls until `done`; false if that takes longer than a test should.
inline bool poll_until(Server& server, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    server.poll(std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace tether::link
