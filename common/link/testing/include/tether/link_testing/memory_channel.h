#pragma once

#include <memory>

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
  /// `events` must outlive the server.
  explicit MemoryServer(link::ServerEvents& events);
  ~MemoryServer() override;

  /// A new connection; the server hears of it in its next poll. From any thread.
  std::unique_ptr<link::Channel> connect();

  /// A placeholder: there is nothing to connect to over TCP.
  link::Address address() const override { return {"memory", 0}; }
  bool poll(Duration max_wait) override;
  void send(link::PeerId peer, link::Message message) override;
  void close(link::PeerId peer) override;

  struct Hub;

 private:
  // Shared with the channels, which may outlive the server.
  std::shared_ptr<Hub> hub_;
  link::ServerEvents& events_;
  link::Encoder encoder_;
};

}  // namespace tether::link_testing
