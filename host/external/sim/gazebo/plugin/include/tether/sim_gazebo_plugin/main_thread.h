#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>

namespace tether::gazebo_plugin {

/// Jobs of the thread of the physics for the only thread that may draw.
class MainThread {
 public:
  /// `wake` makes the main thread call `do_jobs` soon; called repeatedly until it has.
  explicit MainThread(std::function<void()> wake) : wake_(std::move(wake)) {}

  /// Runs `job` there, waits for its end, and throws its exception. False: `give_up`, called about
  /// ten times a second, returned true before the job began.
  bool run(const std::function<void()>& job, const std::function<bool()>& give_up);
  /// To be called in the main thread whenever it may draw.
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
