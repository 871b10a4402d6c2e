#pragma once

#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <tether/client/exec/clock_page.h>
#include <tether/client/exec/local_socket.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::client {

/// tether-exec as far as a vehicle sees it: a socket, a clock, and answers as the test says (none:
/// the call stays open).
class FakeExec {
 public:
  using Answer = std::function<std::optional<link::Message>(const link::Request&)>;

  explicit FakeExec(Answer answer, bool free_running = false) : answer_(std::move(answer)) {
    welcome_.free_running = free_running;
    welcome_.catalogue.sensors = {{"imu", {}, 100.0, uav::ImuProperties{}},
                                  {"down", {}, 10.0, uav::RangeProperties{}},
                                  {"side", {}, 0.0, uav::RangeProperties{}}};
    clock_ = make_clock_page().value();
    clock_.page->publish({ExecTime(std::chrono::seconds(1)), read_monotonic(), 1.0, true});
    listener_ = listen_local(path()).value();
    thread_ = std::thread([this] { run(); });
  }
  ~FakeExec() {
    stopping_ = true;
    thread_.join();
    ::unlink(path().c_str());
    ::rmdir(folder_.c_str());
  }

  std::string path() const { return folder_ + "/socket"; }
  std::unique_ptr<Vehicle> connect() const {
    ConnectOptions options;
    options.exec_socket = path();
    auto vehicle = client::connect(std::move(options));
    EXPECT_TRUE(vehicle.ok()) << vehicle.failure().message;
    return std::move(*vehicle);
  }
  std::size_t connections() const { return connections_; }
  std::size_t requests() const { return requests_; }
  /// Refuses or drops all callers.
  void end(std::optional<link::Refusal> why) {
    const std::lock_guard lock(mutex_);
    end_ = true;
    why_ = std::move(why);
  }

 private:
  void run() {
    while (!stopping_) {
      pollfd nothing{-1, 0, 0};
      ::poll(&nothing, 1, 1);
      while (os::FileDescriptor accepted = accept_local(listener_)) {
        sockets_.emplace_back(std::move(accepted));
        ++connections_;
        EXPECT_TRUE(sockets_.back().send_clock(clock_.descriptor).ok());
      }
      const std::lock_guard lock(mutex_);
      for (auto& socket : sockets_) serve(socket);
      if (!end_) continue;
      // To close a socket with an unread request would reset the connection, and lose the refusal.
      for (auto& socket : sockets_) {
        if (why_) static_cast<void>(socket.send(*why_));
      }
      if (!why_) sockets_.clear();
      answer_ = [](const link::Request&) { return std::nullopt; };
      end_ = false;
    }
  }
  void serve(LocalSocket& socket) {
    auto packet = socket.receive();
    if (!packet || !packet->message) return;
    if (std::holds_alternative<link::Hello>(*packet->message)) {
      static_cast<void>(socket.send(welcome_));
    }
    const auto* request = std::get_if<link::Request>(&*packet->message);
    if (request == nullptr) return;
    ++requests_;
    if (const auto answer = answer_(*request)) static_cast<void>(socket.send(*answer));
  }
  static std::string make_folder() {
    std::string path = "/tmp/tether-fake-exec-XXXXXX";
    return ::mkdtemp(path.data());
  }

  std::string folder_ = make_folder();
  Answer answer_;
  link::Welcome welcome_;
  SharedClockPage clock_;
  os::FileDescriptor listener_;
  std::vector<LocalSocket> sockets_;
  std::atomic<std::size_t> connections_ = 0;
  std::atomic<std::size_t> requests_ = 0;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  bool end_ = false;                  // guarded by mutex_
  std::optional<link::Refusal> why_;  // guarded by mutex_
  std::thread thread_;
};

inline std::optional<link::Message> grant(const link::Request& request) {
  link::Reply reply{request.sequence, request.issued_at, std::nullopt};
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  if (read != nullptr && read->sensor == 0) {
    reply.sample = uav::ImuSample{same_instant(request.issued_at), request.sequence, {}, {}, {}};
  }
  if (read != nullptr && read->sensor == 1) {
    reply.sample = uav::RangeSample{same_instant(request.issued_at), request.sequence, 1.0};
  }
  return reply;
}

inline std::optional<link::Message> all_but_the_rangefinder(const link::Request& request) {
  const auto* read = std::get_if<link::ReadSensor>(&request.body);
  if (read != nullptr && read->sensor == 1) return std::nullopt;
  return grant(request);
}

inline void wait_for(const std::function<bool()>& condition) {
  while (!condition()) std::this_thread::yield();
}

}  // namespace tether::client
