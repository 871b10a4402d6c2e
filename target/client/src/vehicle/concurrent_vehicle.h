#pragma once

#include "vehicle/interacting_vehicle.h"
#include "vehicle/stage_log.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <tether/client/exec/clock_page.h>
#include <tether/client/exec/group_page.h>
#include <tether/client/exec/local_socket.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::client {

/// A UAV in the simulator, reached through tether-exec. Each call has a connection of its own for
/// as long as it lasts, from a pool that grows with the number of calls at once. Calls stamp their
/// requests from the clock page, or the group's; no thread runs here.
class ConcurrentVehicle final : public InteractingVehicle {
 public:
  /// Connects to the socket at `options.exec_socket`.
  static Result<std::unique_ptr<Vehicle>> make(const ConnectOptions& options);

  ExecTime now() const override;
  bool is_concurrent() const override { return true; }
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view topic, std::string_view json) override;
  Status begin_stage(std::string_view stage) override;
  Status end_stage() override;

 private:
  struct Connection {
    explicit Connection(LocalSocket s) : socket(std::move(s)) {}
    LocalSocket socket;
    std::uint64_t sequence = 0;  // of the last request
  };
  /// What a new connection hears first.
  struct Greeting {
    std::unique_ptr<Connection> connection;
    os::FileDescriptor clock_page;
    link::Welcome welcome;
  };
  struct Caller {
    std::string path;
    link::Hello hello;
    Duration welcome_timeout;
  };
  /// What a thread computes between its calls.
  struct Computing {
    StageLog stages;
    std::string previous_call = "start";
  };
  static Result<Greeting> greet(const Caller& caller);

  ConcurrentVehicle(Caller caller, Greeting greeting, MappedClockPage clock, MappedGroupPage group);

  Result<link::Reply> interact(Body body) override;
  void close() override;

  Result<link::Reply> ask(Connection& connection, Body body);
  Result<std::unique_ptr<Connection>> take_connection();
  /// Of the calling thread.
  Computing& computing();
  template <class Change>
  Status change_stage(Change change);
  void give_back(std::unique_ptr<Connection> connection);

  Caller caller_;
  MappedClockPage clock_;
  MappedGroupPage group_;  // if the program's processes share one ET: has it in place of clock_
  bool free_running_;
  mutable std::atomic<ExecTime> latest_{};  // that `now` has shown in free running
  std::mutex mutex_;
  std::vector<std::unique_ptr<Connection>> idle_;   // guarded by mutex_
  std::map<std::thread::id, Computing> computing_;  // the map is guarded by mutex_
};

}  // namespace tether::client
