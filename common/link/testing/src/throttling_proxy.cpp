#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <tether/base/error.h>
#include <tether/link/socket.h>
#include <tether/link_testing/throttling_proxy.h>

/// One thread and one `ppoll`: bytes are read where they come, wait in memory until they would have
/// arrived, and are written then.
namespace tether::link_testing {
namespace {

using SteadyClock = std::chrono::steady_clock;
using link::Descriptor;

constexpr std::size_t kChunkBytes = 16u << 10;
/// What may be on the wire one way; beyond, the sender has to wait as with a full socket.
constexpr std::size_t kMaxInFlightBytes = 8u << 20;
constexpr std::chrono::seconds kConnectLimit{10};

/// One direction of a connection.
class Way {
 public:
  Way(int from, int to, const WireModel& wire) : from_(from), to_(to), schedule_(wire) {}

  bool may_read() const { return !ended_ && in_flight_bytes_ <= kMaxInFlightBytes; }
  /// When the first bytes on the wire arrive.
  SteadyClock::time_point next_arrival() const {
    return in_flight_.empty() ? SteadyClock::time_point::max() : in_flight_.front().arrives;
  }
  void read();
  /// Of what has arrived, what the socket takes. False: nobody is there to take it.
  bool deliver();
  bool is_over() const { return ended_ && in_flight_.empty(); }

 private:
  struct Chunk {
    SteadyClock::time_point arrives;
    std::vector<std::uint8_t> bytes;  // empty: the end of the stream
    std::size_t done = 0;
  };

  int from_;
  int to_;
  WireSchedule schedule_;
  std::deque<Chunk> in_flight_;
  std::size_t in_flight_bytes_ = 0;
  bool ended_ = false;
};

void Way::read() {
  std::array<std::uint8_t, kChunkBytes> space;
  const link::Transfer received = link::receive_some(from_, space);
  if (received.would_block) return;
  ended_ = received.ended || received.error;
  in_flight_bytes_ += received.bytes;
  const Duration now = SteadyClock::now().time_since_epoch();
  const SteadyClock::time_point arrives(schedule_.arrival(now, received.bytes));
  in_flight_.push_back({arrives, {space.data(), space.data() + received.bytes}});
}

bool Way::deliver() {
  Chunk& chunk = in_flight_.front();
  if (chunk.bytes.empty()) {
    ::shutdown(to_, SHUT_WR);
  } else {
    const link::Transfer sent = link::send_some(to_, {chunk.bytes, {}, {}}, chunk.done);
    if (sent.error) return false;
    in_flight_bytes_ -= sent.bytes;
    chunk.done += sent.bytes;
    if (chunk.done < chunk.bytes.size()) return true;
  }
  in_flight_.pop_front();
  return true;
}

/// A client, and the connection to the target that continues it.
class Connection {
 public:
  Connection(Descriptor client, Descriptor server, const WireModel& wire)
      : client_(std::move(client)),
        server_(std::move(server)),
        up_(client_.get(), server_.get(), wire),
        down_(server_.get(), client_.get(), wire) {}

  /// What to wait for at the client and at the server, if it is `now`.
  std::array<pollfd, 2> watched(SteadyClock::time_point now) const {
    return {entry(client_, up_, down_, now), entry(server_, down_, up_, now)};
  }
  SteadyClock::time_point next_arrival(SteadyClock::time_point now) const {
    auto next = SteadyClock::time_point::max();
    for (const Way* way : {&up_, &down_})
      if (way->next_arrival() > now) next = std::min(next, way->next_arrival());
    return next;
  }
  /// False: it is over.
  bool serve(const pollfd& client, const pollfd& server) {
    const bool is_there = serve(client, up_, down_) && serve(server, down_, up_);
    return is_there && !(up_.is_over() && down_.is_over());
  }

 private:
  static pollfd entry(const Descriptor& end, const Way& out, const Way& in,
                      SteadyClock::time_point now) {
    const int events = (out.may_read() ? POLLIN : 0) | (in.next_arrival() <= now ? POLLOUT : 0);
    return {events == 0 ? -1 : end.get(), static_cast<short>(events), 0};
  }
  /// `out` carries what this end sends, `in` what it is sent.
  static bool serve(const pollfd& end, Way& out, Way& in) {
    const int happened = end.events & (end.revents & (POLLERR | POLLHUP) ? ~0 : end.revents);
    if (happened & POLLIN) out.read();
    return !(happened & POLLOUT) || in.deliver();
  }

  Descriptor client_;
  Descriptor server_;
  Way up_;
  Way down_;
};

}  // namespace

Duration WireSchedule::arrival(Duration now, std::size_t bytes) {
  Duration sending{0};
  if (model_.bytes_per_s > 0.0) {
    sending = duration_from_seconds(static_cast<double>(bytes) / model_.bytes_per_s);
  }
  free_at_ = std::max(free_at_, now) + sending;
  return free_at_ + model_.delay;
}

struct ThrottlingProxy::Impl {
  Impl(const link::Address& listen, link::Address to, const WireModel& model)
      : target(std::move(to)), wire(model) {
    auto socket = link::listen_on_tcp(listen);
    if (!socket) {
      throw Error(ErrorCode::kSetup, "proxy from " + link::to_string(listen) + " to " +
                                         link::to_string(target) + ": " + socket.failure().message);
    }
    listening = std::move(*socket);
    link::set_blocking(listening.get(), false);
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~Impl() {
    thread.request_stop();
    ::shutdown(listening.get(), SHUT_RDWR);  // wakes the thread
  }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      wait();
      auto entry = watched.begin() + 1;
      for (auto connection = connections.begin(); connection != connections.end(); entry += 2) {
        const bool is_there = connection->serve(entry[0], entry[1]);
        connection = is_there ? std::next(connection) : connections.erase(connection);
      }
      if (watched.front().revents != 0) accept();
    }
  }

  void wait() {
    const auto now = SteadyClock::now();
    auto wake_at = now + std::chrono::hours(1);
    watched.assign(1, {listening.get(), POLLIN, 0});
    for (const Connection& connection : connections) {
      const auto entries = connection.watched(now);
      watched.insert(watched.end(), entries.begin(), entries.end());
      wake_at = std::min(wake_at, connection.next_arrival(now));
    }
    const std::int64_t ns = Duration(wake_at - now).count();
    const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
    ::ppoll(watched.data(), watched.size(), &timeout, nullptr);
  }

  void accept() {
    link::Accepted client = link::accept_tcp(listening.get());
    if (client.error) return;
    auto server = link::open_tcp(target, kConnectLimit);
    if (!server) return;
    link::set_blocking(server->get(), false);
    connections.emplace_back(std::move(client.socket), std::move(*server), wire);
  }

  link::Address target;
  WireModel wire;
  Descriptor listening;
  std::list<Connection> connections;
  std::vector<pollfd> watched;  // the listening socket, then two per connection, in order
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
