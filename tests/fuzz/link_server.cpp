#include "fuzz_target.h"

#include <set>

#include <netinet/in.h>
#include <sys/socket.h>

#include <tether/link/server.h>
#include <tether/link/socket.h>

/// The coordinator's side: the server, with a peer that sends the input in pieces, and then hangs
/// up. Input: how it hangs up, then pieces, each with its length before it.
namespace tether::fuzz {
namespace {

/// Peers come, speak, and go once, in this order, one event of each per poll.
class Hearing {
 public:
  explicit Hearing(link::Server& server) : server_(server) {}

  /// Until nothing is there.
  void poll() {
    while (poll_once()) {
    }
  }

 private:
  bool poll_once() {
    std::set<link::PeerId> heard;
    for (const link::Event& event : server_.poll(Duration::zero())) {
      require(heard.insert(event.peer).second, "two events of a peer");
      std::visit([&](const auto& what) { take(event.peer, what); }, event.what);
    }
    return !heard.empty();
  }
  void take(link::PeerId peer, const link::Connected&) {
    require(open_.insert(peer).second, "a peer that came twice");
  }
  void take(link::PeerId peer, const link::Message& message) {
    require(open_.contains(peer), "a message of nobody");
    require(link::validate(message).ok(), "a message that may not be sent");
    server_.send(peer, link::Refusal{link::Refusal::Reason::kBadRequest, "heard"});
  }
  void take(link::PeerId peer, const link::Closed& end) {
    require(open_.erase(peer) == 1, "a peer that left twice");
    require_one_line(end.failure.message);
    if (end.may_still_read) server_.close(peer);
  }

  link::Server& server_;
  std::set<link::PeerId> open_;
};

link::Descriptor connect_to(std::uint16_t port) {
  link::Descriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  require(::connect(client.get(), generic, sizeof address) == 0, "cannot connect");
  // Closing resets, so that no port stays taken for a minute.
  const linger reset{1, 0};
  ::setsockopt(client.get(), SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
  return client;
}

/// What the server answers can be read by a client.
void require_answers(const link::Descriptor& client) {
  link::FrameBuffer buffer(link::kMaxReplyBytes);
  while (true) {
    const auto space = buffer.space();
    const ssize_t count = ::recv(client.get(), space.data(), space.size(), MSG_DONTWAIT);
    if (count <= 0) return;
    buffer.commit(static_cast<std::size_t>(count));
    for (auto frame = buffer.next(); frame && !frame->empty(); frame = buffer.next())
      require(link::decode(*frame).ok(), "an answer that no client reads");
  }
}

void talk(link::Server& server, Choices choices) {
  Hearing hearing(server);
  link::Descriptor client = connect_to(server.address().port);
  const bool closes_half = choices.coin();
  while (!choices.empty()) {
    const Bytes piece = choices.take(std::size_t{choices.byte()} * 8 + 1);
    (void)::send(client.get(), piece.data(), piece.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    hearing.poll();
  }
  if (closes_half) ::shutdown(client.get(), SHUT_WR);
  hearing.poll();
  require_answers(client);
  client = link::Descriptor();
  hearing.poll();
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  const auto server = link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(10));
  fuzz::talk(*server, fuzz::Choices({data, size}));
  return 0;
}
