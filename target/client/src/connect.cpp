#include "build_id.h"
#include "vehicle/concurrent_vehicle.h"
#include "vehicle/simulated_vehicle_impl.h"

#include <utility>
#include <variant>

#include <unistd.h>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {
namespace {

link::Hello hello_for(const ConnectOptions& options) {
  link::Hello hello;
  hello.sut = options.sut_name;
  hello.uav = options.uav;
  hello.clock = options.time->clock();
  hello.token = options.token;
  hello.build_id = build_id();
  hello.process = static_cast<std::uint32_t>(::getpid());
  hello.build = build_parts(own_arguments(), loaded_libraries());
  return hello;
}

Result<link::Welcome> shake_hands(link::Channel& channel, const link::Hello& hello,
                                  const ConnectOptions& options) {
  const Status sent = channel.send(hello);
  if (!sent && sent.failure().kind == Failure::Kind::kInvalid) return sent.failure();
  // Even if the Hello did not go out: the coordinator may have refused the connection itself.
  auto message = channel.receive_within(options.welcome_timeout);
  if (!message) return sent ? message.failure() : sent.failure();
  if (const auto* refusal = std::get_if<link::Refusal>(&*message)) return to_failure(*refusal);
  if (auto* welcome = std::get_if<link::Welcome>(&*message)) return std::move(*welcome);
  return Failure{Failure::Kind::kProtocol,
                 "the coordinator answered Hello with neither Welcome nor Refusal"};
}

/// In free running a virtual target is imitated by stalling.
Status check_free_running(const link::Welcome& welcome, const computer::Clock& clock) {
  if (!welcome.free_running) return ok_status();
  if (clock.kind == computer::ClockKind::kCounted) {
    return Failure{
        Failure::Kind::kInvalid,
        "the clock \"counted\" is not allowed in free-running mode, where ST follows the "
        "wall clock: an emulated program takes longer than what it counts"};
  }
  if (clock.kind == computer::ClockKind::kReplayed) {
    return Failure{Failure::Kind::kInvalid,
                   "the clock \"replayed\" is not allowed in free-running mode, where ST follows "
                   "the wall clock"};
  }
  if (clock.kind == computer::ClockKind::kWall && clock.is_scaled()) {
    return Failure{Failure::Kind::kInvalid,
                   "wall*FACTOR is not allowed in free-running mode, where ST follows the wall "
                   "clock. Use cpu*FACTOR"};
  }
  if (clock.factor >= 1.0) return ok_status();
  return Failure{Failure::Kind::kInvalid,
                 "a CPU clock factor below 1 is not allowed in free-running mode: stalling cannot "
                 "imitate a machine that is faster than this one"};
}

Result<std::unique_ptr<Vehicle>> connect_to_exec(const ConnectOptions& options) {
  if (options.time != nullptr && options.time->clock() != computer::Clock{}) {
    return Failure{Failure::Kind::kInvalid,
                   "under tether-exec, the program cannot choose its clock. Set TETHER_CLOCK for "
                   "tether-exec"};
  }
  return ConcurrentVehicle::make(options);
}

/// How often to send Progress; 0: never. A SUT whose runs repeat to the byte sends none: where it
/// would arrive is a race, and a counted SUT must have no other thread. In free running a scripted
/// SUT sends it too.
Duration progress_period(const ConnectOptions& options, const link::Welcome& welcome) {
  if (welcome.free_running) return options.heartbeat_period;
  return options.time->clock().repeats() ? Duration::zero() : options.progress_period;
}

Result<std::unique_ptr<Vehicle>> join(std::unique_ptr<link::Channel> channel,
                                      const link::Hello& hello, ConnectOptions options) {
  auto welcome = shake_hands(*channel, hello, options);
  if (!welcome) return welcome.failure();
  if (const Status good = check_free_running(*welcome, options.time->clock()); !good)
    return good.failure();
  const Duration period = progress_period(options, *welcome);
  return std::unique_ptr<Vehicle>(std::make_unique<SimulatedVehicle>(
      std::move(channel), std::move(*welcome), std::move(options.time), make_wall_timer(), period));
}

}  // namespace

Result<std::unique_ptr<Vehicle>> connect(std::unique_ptr<link::Channel> channel,
                                         ConnectOptions options) {
  if (!options.time) options.time = make_wall_source();
  const link::Hello hello = hello_for(options);
  return join(std::move(channel), hello, std::move(options));
}

Result<link::Reply> pass_on(Vehicle& vehicle, decltype(link::Request::body) body) {
  return dynamic_cast<InteractingVehicle&>(vehicle).pass_on(std::move(body));
}

Result<std::unique_ptr<Vehicle>> connect(ConnectOptions options) {
  if (!options.exec_socket.empty()) return connect_to_exec(options);
  if (!options.time) options.time = make_wall_source();
  // Before there is a connection, on which the coordinator expects Hello soon: files are read.
  const link::Hello hello = hello_for(options);
  auto channel = link::connect_tcp(options.address, options.connect_timeout);
  if (!channel) return channel.failure();
  return join(std::move(*channel), hello, std::move(options));
}

}  // namespace tether::client
