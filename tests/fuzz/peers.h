#pragma once

#include "fuzz_target.h"

#include <map>
#include <optional>
#include <span>

#include <tether/link/server.h>

namespace tether::fuzz {

/// A server whose peers do what the input says, honest or not, one thing per poll; then all hang
/// up. No thread, socket or clock.
class Peers final : public link::Server {
 public:
  explicit Peers(Choices choices) : choices_(choices) {}

  bool finished() const { return choices_.empty(); }

  link::Address address() const override { return {"fuzz", 0}; }
  std::span<link::Event> poll(Duration max_wait) override;
  void send(link::PeerId id, link::Message message) override;
  std::uint64_t moved_bytes(link::PeerId) override { return 0; }
  void close(link::PeerId id) override { peers_.erase(id); }

  /// Host time that has passed because the input said so.
  Duration passed{0};

 private:
  struct Peer {
    ExecTime et;
    std::uint64_t sequence = 0;
  };
  void go_on();
  void come();
  void leave(link::PeerId id);
  void speak(link::PeerId id, Peer& peer);
  link::Hello hello();
  link::Message message(Peer& peer);
  link::Request request(Peer& peer);
  ExecTime stamp(ExecTime from);

  Choices choices_;
  std::optional<link::PeerId> came_;  // says its Hello next
  std::optional<link::Event> event_;  // of the last poll
  std::map<link::PeerId, Peer> peers_;
  link::PeerId last_id_ = 0;
};

}  // namespace tether::fuzz
