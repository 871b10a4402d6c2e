#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>

#include <tether/base/error.h>
#include <tether/link_testing/throttling_proxy.h>

namespace tether::link_testing {
namespace {

using Tcp = asio::ip::tcp;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kChunkBytes = 16u << 10;
/// What may be on the wire one way; beyond, the sender has to wait as with a full socket.
constexpr std::size_t kMaxInFlightBytes = 8u << 20;

/// One connection, both ways. Its pending operations keep it alive (shared_ptr, as in Asio's own
/// examples).
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket client, const WireModel& wire)
      : client_(std::move(client)),
        server_(client_.get_executor()),
        up_{client_, server_, asio::steady_timer(client_.get_executor()), WireSchedule(wire)},
        down_{server_, client_, asio::steady_timer(client_.get_executor()), WireSchedule(wire)} {}

  void start(const Tcp::resolver::results_type& target) {
    asio::async_connect(server_, target,
                        [self = shared_from_this()](std::error_code error, const Tcp::endpoint&) {
                          if (error) return self->close();
                          self->go();
                        });
  }

 private:
  struct Chunk {
    SteadyClock::time_point arrives;
    std::vector<std::uint8_t> bytes;  // empty: the end of the stream
  };
  struct Way {
    Tcp::socket& from;
    Tcp::socket& to;
    asio::steady_timer timer;
    WireSchedule schedule;
    std::array<std::uint8_t, kChunkBytes> received{};
    std::deque<Chunk> in_flight{};
    std::size_t in_flight_bytes = 0;
    bool reading = false;
    bool ended = false;
  };

  void go() {
    for (Tcp::socket* socket : {&client_, &server_}) {
      std::error_code ignored;
      socket->set_option(Tcp::no_delay(true), ignored);
    }
    read(up_);
    read(down_);
  }

  void read(Way& way) {
    if (way.reading || way.ended || way.in_flight_bytes > kMaxInFlightBytes) return;
    way.reading = true;
    way.from.async_read_some(
        asio::buffer(way.received),
        [self = shared_from_this(), &way](std::error_code error, std::size_t bytes) {
          way.reading = false;
          if (error) way.ended = true;
          self->put_on_wire(way, error ? 0 : bytes);
          self->read(way);
        });
  }

  void put_on_wire(Way& way, std::size_t bytes) {
    const Duration now = SteadyClock::now().time_since_epoch();
    const SteadyClock::time_point arrives(way.schedule.arrival(now, bytes));
    const auto first = way.received.begin();
    way.in_flight.push_back({arrives, {first, first + static_cast<std::ptrdiff_t>(bytes)}});
    way.in_flight_bytes += bytes;
    if (way.in_flight.size() == 1) await_front(way);
  }

  void await_front(Way& way) {
    way.timer.expires_at(way.in_flight.front().arrives);
    way.timer.async_wait([self = shared_from_this(), &way](std::error_code error) {
      if (!error) self->deliver_front(way);
    });
  }

  void deliver_front(Way& way) {
    if (way.in_flight.front().bytes.empty()) {
      std::error_code ignored;
      way.to.shutdown(Tcp::socket::shutdown_send, ignored);
      return;
    }
    asio::async_write(way.to, asio::buffer(way.in_flight.front().bytes),
                      [self = shared_from_this(), &way](std::error_code error, std::size_t bytes) {
                        if (error) return self->close();
                        way.in_flight_bytes -= bytes;
                        way.in_flight.pop_front();
                        if (!way.in_flight.empty()) self->await_front(way);
                        self->read(way);
                      });
  }

  void close() {
    std::error_code ignored;
    client_.close(ignored);
    server_.close(ignored);
  }

  Tcp::socket client_;
  Tcp::socket server_;
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
  Impl(const link::Address& listen, const link::Address& target, const WireModel& model)
      : wire(model) {
    try {
      Tcp::resolver resolver(context);
      targets = resolver.resolve(target.host, std::to_string(target.port));
      const Tcp::endpoint local =
          resolver.resolve(listen.host, std::to_string(listen.port)).begin()->endpoint();
      acceptor = Tcp::acceptor(context, local);
      const Tcp::endpoint bound = acceptor.local_endpoint();
      address = {bound.address().to_string(), bound.port()};
    } catch (const std::system_error& error) {
      throw Error(ErrorCode::kSetup, "proxy from " + link::to_string(listen) + " to " +
                                         link::to_string(target) + ": " + error.what());
    }
    accept();
    thread = std::thread([this] { context.run(); });
  }

  ~Impl() {
    context.stop();
    thread.join();
  }

  void accept() {
    acceptor.async_accept([this](std::error_code error, Tcp::socket client) {
      if (!error) std::make_shared<Connection>(std::move(client), wire)->start(targets);
      accept();
    });
  }

  asio::io_context context{1};
  Tcp::acceptor acceptor{context};
  Tcp::resolver::results_type targets;
  WireModel wire;
  link::Address address;
  std::thread thread;
};

ThrottlingProxy::ThrottlingProxy(const link::Address& listen, const link::Address& target,
                                 const WireModel& wire)
    : impl_(std::make_unique<Impl>(listen, target, wire)) {}

ThrottlingProxy::~ThrottlingProxy() = default;

link::Address ThrottlingProxy::address() const {
  return impl_->address;
}

}  // namespace tether::link_testing
