#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/socket.h>

#include <tether/base/error.h>
#include <tether/link/socket.h>
#include <tether/link_testing/throttling_proxy.h>

/// Two threads for each direction of a connection: one reads bytes as they come, the other writes
/// them at the time at which they would have arrived.
namespace tether::link_testing {
namespace {

using SteadyClock = std::chrono::steady_clock;
using link::Descriptor;

constexpr std::size_t kChunkBytes = 16u << 10;
/// Chunks on the wire in one direction; beyond, the sender has to wait as with a full socket.
constexpr std::size_t kMaxChunks = 512;
constexpr std::chrono::seconds kConnectLimit{10};

/// One direction of a connection. Both sockets are shut down before it is destroyed.
class Way {
 public:
  Way(int from, int to, const WireModel& wire) : from_(from), to_(to), schedule_(wire) {
    reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
    writer_ = std::jthread([this](const std::stop_token& stop) { deliver(stop); });
  }

 private:
  struct Chunk {
    SteadyClock::time_point arrives;
    std::vector<std::uint8_t> bytes;  // empty: the end of the stream
  };

  void read(const std::stop_token& stop) {
    for (bool has_ended = false; !has_ended;) {
      std::vector<std::uint8_t> bytes(kChunkBytes);
      bytes.resize(link::receive_some(from_, bytes).bytes);
      has_ended = bytes.empty();
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return in_flight_.size() < kMaxChunks; })) return;
      const Duration now = SteadyClock::now().time_since_epoch();
      const SteadyClock::time_point arrives(schedule_.arrival(now, bytes.size()));
      in_flight_.push_back({arrives, std::move(bytes)});
      changed_.notify_all();
    }
  }

  void deliver(const std::stop_token& stop) {
    for (bool has_ended = false; !has_ended;) {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return !in_flight_.empty(); })) return;
      const Chunk chunk = std::move(in_flight_.front());
      in_flight_.pop_front();
      changed_.notify_all();
      changed_.wait_until(lock, stop, chunk.arrives, [] { return false; });
      lock.unlock();
      has_ended = chunk.bytes.empty();
      if (has_ended) ::shutdown(to_, SHUT_WR);
      link::Transfer sent;
      for (std::size_t done = 0; done < chunk.bytes.size() && !sent.error; done += sent.bytes)
        sent = link::send_some(to_, {chunk.bytes, {}, {}}, done);
      if (sent.error) ::shutdown(from_, SHUT_RDWR);
    }
  }

  const int from_, to_;
  WireSchedule schedule_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Chunk> in_flight_;
  std::jthread reader_, writer_;
};

/// A client, and the connection to the target that continues it.
class Connection {
 public:
  Connection(Descriptor client, Descriptor server, const WireModel& wire)
      : client_(std::move(client)),
        server_(std::move(server)),
        up_(client_.get(), server_.get(), wire),
        down_(server_.get(), client_.get(), wire) {}
  ~Connection() {
    for (const Descriptor* end : {&client_, &server_}) ::shutdown(end->get(), SHUT_RDWR);
  }

 private:
  Descriptor client_, server_;
  Way up_, down_;
};

}  // namespace

Duration WireSchedule::arrival(Duration now, std::size_t bytes) {
  Duration sending{0};
  if (model_.bytes_per_s > 0.0)
    sending = duration_from_seconds(static_cast<double>(bytes) / model_.bytes_per_s);
  free_at_ = std::max(free_at_, now) + sending;
  return free_at_ + model_.delay;
}

struct ThrottlingProxy::Impl {
  Impl(const link::Address& listen, const link::Address& target, const WireModel& wire) {
    auto socket = link::listen_on_tcp(listen);
    if (!socket) throw Error(ErrorCode::kSetup, "proxy: " + socket.failure().message);
    listening = std::move(*socket);
    thread = std::jthread([this, target, wire](const std::stop_token& stop) {
      while (!stop.stop_requested()) accept(target, wire);
    });
  }
  ~Impl() {
    thread.request_stop();
    ::shutdown(listening.get(), SHUT_RDWR);  // wakes the thread
  }

  void accept(const link::Address& target, const WireModel& wire) {
    link::Accepted client = link::accept_tcp(listening.get());
    if (client.error) return;
    auto server = link::open_tcp(target, kConnectLimit);
    if (!server) return;
    link::set_blocking(client.socket.get(), true);
    connections.emplace_back(std::move(client.socket), std::move(*server), wire);
  }

  Descriptor listening;
  std::list<Connection> connections;
  std::jthread thread;
};

ThrottlingProxy::ThrottlingProxy(const link::Address& listen, const link::Address& target,
                                 const WireModel& wire)
    : impl_(std::make_unique<Impl>(listen, target, wire)) {}

ThrottlingProxy::~ThrottlingProxy() = default;

link::Address ThrottlingProxy::address() const {
  return link::local_address(impl_->listening.get());
}

}  // namespace tether::link_testing
