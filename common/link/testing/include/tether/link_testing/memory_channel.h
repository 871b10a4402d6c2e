#pragma once

#include <memory>
#include <optional>
#include <span>

#include <tether/link/channel.h>
#include <tether/link/server.h>

namespace tether::link_testing {

/// The link without sockets, for tests: a Server whose connections are queues in memory. Messages
/// go through the codec as on the wire, in order and whole; what one side sends before it closes,
/// the other side still receives.
///
/// The server belongs to one thread, as any Server; each channel may belong to another. Channels
/// may outlive the server: they find themselves disconnected.
class MemoryServer final : public link::Server {
 public:
  MemoryServer();
  ~MemoryServer() override;

  /// A new connection; the server hears of it in its next poll. From any thread.
  std::unique_ptr<link::Channel> connect();

  /// A placeholder: there is nothing to connect to over TCP.
  link::Address address() const override { return {"memory", 0}; }
  /// One event at most.
  std::span<link::Event> poll(Duration max_wait) override;
  void send(link::PeerId peer, link::Message message) override;
  void close(link::PeerId peer) override;

  struct Hub;

 private:
  // Shared with the channels, which may outlive the server.
  std::shared_ptr<Hub> hub_;
  std::optional<link::Event> event_;  // of the last poll
  link::Encoder encoder_;
};

}  // namespace tether::link_testing
