#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <tether/base/text.h>
#include <tether/link/server.h>

namespace tether::coordinator {

/// The connections of a run, and which of them are those of its SUTs.
class Peers {
 public:
  using OnRefused = std::function<void(const std::string& address, const std::string& reason)>;

  void begin(link::Server& server, OnRefused on_refused) {
    server_ = &server;
    on_refused_ = std::move(on_refused);
  }

  std::span<link::Event> poll(Duration wait) { return server_->poll(wait); }
  void send(link::PeerId peer, link::Message message) { server_->send(peer, std::move(message)); }
  std::uint64_t moved_bytes(link::PeerId peer) const { return server_->moved_bytes(peer); }

  void connected(link::PeerId peer, const std::string& address) { addresses_[peer] = address; }
  std::string address(link::PeerId peer) const {
    const auto known = addresses_.find(peer);
    return known == addresses_.end() ? "" : known->second;
  }
  /// It is the SUT of that UAV.
  void joined(link::PeerId peer, std::size_t uav) { uavs_[peer] = uav; }
  std::size_t count_joined() const { return uavs_.size(); }
  /// None: it has not joined.
  std::optional<std::size_t> uav_of(link::PeerId peer) const {
    const auto joined = uavs_.find(peer);
    return joined == uavs_.end() ? std::nullopt : std::optional(joined->second);
  }

  /// Tells the caller that a connection was of no use.
  void report(link::PeerId peer, const std::string& reason) const {
    if (on_refused_) on_refused_(address(peer), reason);
  }
  void refuse(link::PeerId peer, link::Refusal::Reason reason, const std::string& message) {
    if (reason != link::Refusal::Reason::kRunEnded) report(peer, printable(message));
    send(peer, link::Refusal{reason, printable(message)});
    server_->close(peer);
    forget(peer);  // no more events from it
  }
  void close(link::PeerId peer) { server_->close(peer); }
  void forget(link::PeerId peer) { addresses_.erase(peer); }

 private:
  link::Server* server_ = nullptr;
  OnRefused on_refused_;
  std::map<link::PeerId, std::string> addresses_;
  std::map<link::PeerId, std::size_t> uavs_;
};

}  // namespace tether::coordinator
