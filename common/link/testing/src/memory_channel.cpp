#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/error.h>
#include <tether/link_testing/memory_channel.h>

namespace tether::link_testing {
namespace {

using link::Message;
using link::PeerId;
using Frame = std::vector<std::uint8_t>;

constexpr Duration kLongestWait = std::chrono::hours(24);

/// Both directions of one connection. Guarded by the hub's mutex.
struct Connection {
  std::deque<Frame> to_server;
  std::deque<Frame> to_client;
  bool announced = false;  // the server has heard of it
  bool client_closed = false;
  bool server_closed = false;
};

}  // namespace

struct MemoryServer::Hub {
  std::mutex mutex;
  std::condition_variable to_server;
  std::condition_variable to_client;
  std::map<PeerId, Connection> connections;  // ordered: peers are served in the order they came
  PeerId next_id = 1;
  bool server_gone = false;
};

namespace {

class MemoryChannel final : public link::Channel {
 public:
  MemoryChannel(std::shared_ptr<MemoryServer::Hub> hub, PeerId id)
      : hub_(std::move(hub)), id_(id) {}
  ~MemoryChannel() override { close(); }

  Status send(const Message& message) override;
  Result<Message> receive() override { return receive_within(kLongestWait); }
  Result<Message> receive_within(Duration timeout) override;
  void close() override;

 private:
  /// Null: the server has dropped the connection or is gone. @pre hub's mutex held
  Connection* connection() {
    const auto found = hub_->connections.find(id_);
    return found == hub_->connections.end() ? nullptr : &found->second;
  }
  bool is_open() {
    const Connection* c = connection();
    return c != nullptr && !c->client_closed && !c->server_closed && !hub_->server_gone;
  }

  std::shared_ptr<MemoryServer::Hub> hub_;
  PeerId id_;
};

const Failure kClosed{Failure::Kind::kDisconnected, "the memory server closed the connection"};

Status MemoryChannel::send(const Message& message) {
  if (Status valid = link::validate(message); !valid) return valid;
  link::Encoder encoder;
  const auto bytes = encoder.encode(message);
  const std::lock_guard lock(hub_->mutex);
  if (!is_open()) return kClosed;
  connection()->to_server.emplace_back(bytes.begin(), bytes.end());
  hub_->to_server.notify_all();
  return ok_status();
}

Result<Message> MemoryChannel::receive_within(Duration timeout) {
  std::unique_lock lock(hub_->mutex);
  const auto something = [this] {
    const Connection* c = connection();
    return !is_open() || !c->to_client.empty();
  };
  if (!hub_->to_client.wait_for(lock, std::min(timeout, kLongestWait), something)) {
    return Failure{Failure::Kind::kTimeout, "no answer from the memory server within the limit"};
  }
  Connection* const c = connection();
  if (c == nullptr || c->client_closed || c->to_client.empty()) return kClosed;
  const Frame frame = std::move(c->to_client.front());
  c->to_client.pop_front();
  lock.unlock();
  return link::decode(frame);
}

void MemoryChannel::close() {
  const std::lock_guard lock(hub_->mutex);
  if (Connection* c = connection()) c->client_closed = true;
  hub_->to_server.notify_all();
  hub_->to_client.notify_all();
}

link::Message decoded(const Frame& frame) {
  auto message = link::decode(frame);
  if (!message) throw Error(ErrorCode::kInternal, message.failure().message);
  return std::move(message).value();
}

/// Takes the next event, peers in turn of their ids. @pre hub's mutex held
std::optional<link::Event> take_event(MemoryServer::Hub& hub) {
  for (auto it = hub.connections.begin(); it != hub.connections.end(); ++it) {
    const PeerId id = it->first;
    Connection& c = it->second;
    if (c.server_closed) {
      if (!c.client_closed) continue;
      hub.connections.erase(it);
      return take_event(hub);
    }
    if (!std::exchange(c.announced, true))
      return link::Event{id, link::Connected{"memory:" + std::to_string(id)}};
    if (!c.to_server.empty()) {
      link::Event event{id, decoded(c.to_server.front())};
      c.to_server.pop_front();
      return event;
    }
    if (c.client_closed) {
      hub.connections.erase(it);
      return link::Event{id, link::Closed{{Failure::Kind::kDisconnected, "the client closed"}}};
    }
  }
  return std::nullopt;
}

}  // namespace

MemoryServer::MemoryServer() : hub_(std::make_shared<Hub>()) {}

MemoryServer::~MemoryServer() {
  const std::lock_guard lock(hub_->mutex);
  hub_->server_gone = true;
  hub_->to_client.notify_all();
}

std::unique_ptr<link::Channel> MemoryServer::connect() {
  const std::lock_guard lock(hub_->mutex);
  const PeerId id = hub_->next_id++;
  hub_->connections[id];
  hub_->to_server.notify_all();
  return std::make_unique<MemoryChannel>(hub_, id);
}

std::span<link::Event> MemoryServer::poll(Duration max_wait) {
  std::unique_lock lock(hub_->mutex);
  hub_->to_server.wait_for(lock, std::min(max_wait, kLongestWait), [&] {
    event_ = take_event(*hub_);
    return event_.has_value();
  });
  if (!event_) return {};
  return {&*event_, 1};
}

void MemoryServer::send(PeerId peer, Message message) {
  if (const Status valid = link::validate(message); !valid) {
    throw Error(ErrorCode::kInternal, valid.failure().message);
  }
  const auto bytes = encoder_.encode(message);
  const std::lock_guard lock(hub_->mutex);
  const auto found = hub_->connections.find(peer);
  if (found == hub_->connections.end() || found->second.server_closed) return;
  found->second.to_client.emplace_back(bytes.begin(), bytes.end());
  hub_->to_client.notify_all();
}

void MemoryServer::close(PeerId peer) {
  const std::lock_guard lock(hub_->mutex);
  const auto found = hub_->connections.find(peer);
  if (found == hub_->connections.end()) return;
  found->second.server_closed = true;
  hub_->to_client.notify_all();
}

}  // namespace tether::link_testing
