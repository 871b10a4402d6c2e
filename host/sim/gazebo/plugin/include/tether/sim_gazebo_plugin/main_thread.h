#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>

namespace tether::gazebo_plugin {

/// Work for the one thread that may draw, asked for by the thread of the physics.
class MainThread {
 public:
  /// `wake` makes the main thread call `do_jobs` soon; called again and again until it has.
  explicit MainThread(std::function<void()> wake) : wake_(std::move(wake)) {}

  /// Runs `job` there and waits for its end. What it throws is thrown here. False: it has not been
  /// begun when `give_up`, asked some ten times a second, said so.
  bool run(const std::function<void()>& job, const std::function<bool()>& give_up);
  /// In the main thread, whenever it may draw.
  void do_jobs();

 private:
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable done_;
  const std::function<void()>* job_ = nullptr;
  bool running_ = false;
  std::exception_ptr error_;
};

}  // namespace tether::gazebo_plugin
