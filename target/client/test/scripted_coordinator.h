#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <tether/link/server.h>

namespace tether::client {

/// The other end of a vehicle, in a thread of its own: answers as the test says, and keeps what it
/// heard. By default it grants every request at its own timestamp.
class ScriptedCoordinator {
 public:
  using Answer = std::function<std::vector<link::Message>(const link::Request&)>;

  explicit ScriptedCoordinator(link::Message greeting, Answer answer = grant_at_once)
      : greeting_(std::move(greeting)), answer_(std::move(answer)) {
    thread_ = std::thread([this] {
      while (!stopping_)
        for (link::Event& event : server_->poll(std::chrono::milliseconds(20))) take(event);
    });
  }
  ~ScriptedCoordinator() { stop(); }

  std::unique_ptr<link::Channel> connect() {
    return link::connect_tcp(server_->address(), std::chrono::seconds(20)).value();
  }

  static std::vector<link::Message> grant_at_once(const link::Request& request) {
    return {link::Reply{request.sequence, request.issued_at, std::nullopt}};
  }

  /// Blocks until the message has come for which `wanted` holds; false: it never did.
  bool wait_for(const std::function<bool(const link::Message&)>& wanted) {
    return wait_for_all([&](const std::vector<link::Message>& heard) {
      return std::any_of(heard.begin(), heard.end(), wanted);
    });
  }
  /// Blocks until `wanted` holds for everything heard so far; false: it never did.
  bool wait_for_all(const std::function<bool(const std::vector<link::Message>&)>& wanted) {
    std::unique_lock lock(mutex_);
    return heard_more_.wait_for(lock, std::chrono::seconds(20), [&] { return wanted(heard_); });
  }
  /// Everything that it heard, in order.
  std::vector<link::Message> heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  std::vector<link::Request> requests() {
    std::vector<link::Request> out;
    for (const auto& message : heard()) {
      if (const auto* request = std::get_if<link::Request>(&message)) out.push_back(*request);
    }
    return out;
  }
  /// Blocks until the vehicle has gone.
  void wait_for_end() {
    std::unique_lock lock(mutex_);
    heard_more_.wait_for(lock, std::chrono::seconds(20), [&] { return closed_; });
  }

 private:
  void take(const link::Event& event) {
    if (const auto* message = std::get_if<link::Message>(&event.what))
      on_message(event.peer, *message);
    if (std::holds_alternative<link::Closed>(event.what)) on_closed();
  }
  void on_message(link::PeerId peer, const link::Message& message) {
    {
      const std::lock_guard lock(mutex_);
      heard_.push_back(message);
      heard_more_.notify_all();
    }
    if (std::holds_alternative<link::Hello>(message)) return server_->send(peer, greeting_);
    const auto* request = std::get_if<link::Request>(&message);
    if (request == nullptr) return;
    for (auto& answer : answer_(*request)) server_->send(peer, std::move(answer));
  }
  void on_closed() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    heard_more_.notify_all();
  }
  void stop() {
    stopping_ = true;
    thread_.join();
  }

  link::Message greeting_;
  Answer answer_;
  std::unique_ptr<link::Server> server_ =
      link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(20));
  std::mutex mutex_;
  std::condition_variable heard_more_;
  std::vector<link::Message> heard_;
  bool closed_ = false;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// A Welcome with one sensor of each kind: "camera" (4 × 2 px), "imu", "down".
inline link::Welcome welcome_with_sensors() {
  link::Welcome welcome;
  welcome.catalogue.uav = "uav";
  uav::CameraModel model;
  model.width_px = 4;
  model.height_px = 2;
  model.fx_px = model.fy_px = 3.0;
  welcome.catalogue.sensors = {{"camera", {}, 30.0, uav::CameraProperties{model}},
                               {"imu", {}, 0.0, uav::ImuProperties{}},
                               {"down", {}, 10.0, uav::RangeProperties{0.1, 8.0}}};
  return welcome;
}

}  // namespace tether::client
