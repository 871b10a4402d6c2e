#include "vehicle/concurrent_vehicle.h"

#include "vehicle/cancellation.h"

#include <string>
#include <utility>
#include <variant>

#include <unistd.h>

// The vehicle of a program under tether-exec. Each call takes a connection from a pool, or makes
// one, so that threads do not wait for each other; ET is read from the shared clock page. The
// first failure that ends the run is kept for all later calls.
namespace tether::client {
namespace {

const Failure kCancelled{Failure::Kind::kInvalid, "the subscription of this call has ended"};

Failure unexpected(const std::string& what) {
  return {Failure::Kind::kProtocol,
          "tether-exec answered with " + what +
              ". Use a tether-exec of the same version as this program's library"};
}

Result<link::Welcome> welcome_from(Result<LocalSocket::Packet> packet) {
  if (!packet) return packet.failure();
  if (!packet->message) return unexpected("a clock instead of a Welcome");
  if (const auto* refusal = std::get_if<link::Refusal>(&*packet->message)) {
    return to_failure(*refusal);
  }
  auto* welcome = std::get_if<link::Welcome>(&*packet->message);
  if (welcome == nullptr) return unexpected("neither Welcome nor Refusal");
  return std::move(*welcome);
}

}  // namespace

// --- connecting ---------------------------------------------------------------------------------

Result<std::unique_ptr<Vehicle>> ConcurrentVehicle::make(const ConnectOptions& options) {
  Caller caller{options.exec_socket, {}, options.welcome_timeout};
  caller.hello.sut = options.sut_name;
  caller.hello.uav = options.uav;
  caller.hello.concurrent = true;
  auto greeting = greet(caller);
  if (!greeting) return greeting.failure();
  auto clock = map_clock_page(greeting->clock_page);
  if (!clock) return clock.failure();
  MappedGroupPage group;
  const std::string page = group_page_beside(options.exec_socket);
  if (options.sut_name != kGroupAgent && ::access(page.c_str(), F_OK) == 0) {
    auto mapped = map_group_page(page);
    if (!mapped) return mapped.failure();
    group = std::move(*mapped);
  }
  return std::unique_ptr<Vehicle>(new ConcurrentVehicle(std::move(caller), std::move(*greeting),
                                                        std::move(*clock), std::move(group)));
}

Result<ConcurrentVehicle::Greeting> ConcurrentVehicle::greet(const Caller& caller) {
  auto socket = connect_local(caller.path);
  if (!socket) return socket.failure();
  Greeting greeting;
  greeting.connection = std::make_unique<Connection>(std::move(*socket));
  LocalSocket& local = greeting.connection->socket;
  auto first = local.receive(caller.welcome_timeout);
  if (!first) return first.failure();
  if (first->message) return unexpected("no clock");
  greeting.clock_page = std::move(first->clock_page);
  if (const Status sent = local.send(caller.hello); !sent) return sent.failure();
  auto welcome = welcome_from(local.receive(caller.welcome_timeout));
  if (!welcome) return welcome.failure();
  greeting.welcome = std::move(*welcome);
  return greeting;
}

ConcurrentVehicle::ConcurrentVehicle(Caller caller, Greeting greeting, MappedClockPage clock,
                                     MappedGroupPage group)
    : InteractingVehicle(std::move(greeting.welcome.catalogue), std::move(greeting.welcome.peers)),
      caller_(std::move(caller)),
      clock_(std::move(clock)),
      group_(std::move(group)),
      free_running_(greeting.welcome.free_running) {
  give_back(std::move(greeting.connection));
}

Result<std::unique_ptr<ConcurrentVehicle::Connection>> ConcurrentVehicle::take_connection() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto connection = std::move(idle_.back());
      idle_.pop_back();
      return connection;
    }
  }
  auto greeting = greet(caller_);
  if (!greeting) return greeting.failure();
  return std::move(greeting->connection);
}

void ConcurrentVehicle::give_back(std::unique_ptr<Connection> connection) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(connection));
}

// --- stages -------------------------------------------------------------------------------------

ConcurrentVehicle::Computing& ConcurrentVehicle::computing() {
  const ExecTime at = now();
  const std::lock_guard lock(mutex_);
  return computing_.try_emplace(std::this_thread::get_id(), Computing{StageLog(at)}).first->second;
}

template <class Change>
Status ConcurrentVehicle::change_stage(Change change) {
  if (const Status good = usable(); !good) return good;
  StageLog& stages = computing().stages;
  if (!free_running_) stages.reach(now());
  return change(stages);
}

Status ConcurrentVehicle::begin_stage(std::string_view stage) {
  return change_stage([&](StageLog& stages) { return stages.begin(stage); });
}

Status ConcurrentVehicle::end_stage() {
  return change_stage([](StageLog& stages) { return stages.end(); });
}

// --- calls --------------------------------------------------------------------------------------

Result<link::Reply> ConcurrentVehicle::interact(Body body) {
  if (const Status good = usable(); !good) return good.failure();
  Cancellation* const cancellation = Cancellation::of_this_thread();
  const bool finishes = std::holds_alternative<link::Finish>(body);
  auto connection = take_connection();
  if (!connection) return give_up(connection.failure());
  auto reply = ask(**connection, std::move(body));
  if (reply && finishes) give_up(mission_finished());
  // If the reply came first, it counts; but the connection may have been shut down since.
  if (cancellation != nullptr && cancellation->is_cancelled()) {
    return reply ? std::move(reply) : kCancelled;
  }
  if (reply) {
    give_back(std::move(*connection));
    return reply;
  }
  if (reply.failure().kind == Failure::Kind::kInvalid) {
    give_back(std::move(*connection));
    return reply;
  }
  return give_up(reply.failure());
}

Result<link::Reply> ConcurrentVehicle::ask(Connection& connection, Body body) {
  const Cancellation::Wait wait(Cancellation::of_this_thread(),
                                [&] { connection.socket.shut_down(); });
  Computing& own = computing();
  const ExecTime stamp = now();
  if (!free_running_) own.stages.reach(stamp);
  if (auto* sleep = std::get_if<link::Sleep>(&body); sleep && sleep->is_relative)
    sleep->until = add_within_bounds(stamp, sleep->until.time_since_epoch());
  const std::string call = name_of_call(body, catalogue());
  const link::Request request{connection.sequence + 1, stamp, Duration(0), std::move(body),
                              own.stages.times(link::stage_between(own.previous_call, call))};
  const Status sent = connection.socket.send(request);
  if (!sent && sent.failure().kind == Failure::Kind::kInvalid) return sent.failure();
  // Even if the request did not go out: tether-exec may have said why before it hung up.
  auto packet = connection.socket.receive();
  if (packet && packet->message) {
    const auto* refusal = std::get_if<link::Refusal>(&*packet->message);
    if (refusal != nullptr) return to_failure(*refusal);
  }
  if (!sent) return sent.failure();
  if (!packet) return packet.failure();
  auto* reply = packet->message ? std::get_if<link::Reply>(&*packet->message) : nullptr;
  if (reply == nullptr) return protocol_failure("it is not a Reply");
  if (const Status good = check(*reply, request, catalogue(), free_running_); !good)
    return good.failure();
  connection.sequence = request.sequence;
  own.previous_call = call;
  own.stages.resume(now());
  return std::move(*reply);
}

void ConcurrentVehicle::close() {
  const std::lock_guard lock(mutex_);
  idle_.clear();
}

// In free running, a reply can show that ST is behind what the page said.
ExecTime ConcurrentVehicle::now() const {
  count_clock_read();
  if (group_) return group_->now();
  const ExecTime now = clock_.page->now();
  if (!free_running_) return now;
  ExecTime latest = latest_.load();
  while (latest < now && !latest_.compare_exchange_weak(latest, now)) {
  }
  return std::max(latest, now);
}

// In free running, what this side knows of ST is an estimate: the coordinator takes the time. `ask`
// adds the stamp.
Status ConcurrentVehicle::sleep_for(Duration duration) {
  if (!free_running_) return sleep_until(add_within_bounds(now(), duration));
  return status_of(interact(link::Sleep{add_within_bounds({}, duration), true}));
}

Status ConcurrentVehicle::sleep_until(ExecTime until) {
  // The preloaded library has this sleep, as any other of the program.
  if (group_) {
    if (const Status good = usable(); !good) return good;
    std::this_thread::sleep_for(until - now());
    return ok_status();
  }
  return status_of(interact(make_sleep(until)));
}

Status ConcurrentVehicle::annotate(std::string_view topic, std::string_view json) {
  if (const Status good = usable(); !good) return good;
  auto connection = take_connection();
  if (!connection) return give_up(connection.failure());
  const Status sent =
      (*connection)->socket.send(link::Annotation{now(), std::string(topic), std::string(json)});
  if (sent || sent.failure().kind == Failure::Kind::kInvalid) {
    give_back(std::move(*connection));
    return sent;
  }
  return give_up(sent.failure());
}

}  // namespace tether::client
