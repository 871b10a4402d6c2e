#include <chrono>
#include <utility>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

constexpr std::chrono::milliseconds kJobLook{100};

}  // namespace

bool MainThread::run(const std::function<void()>& job, const std::function<bool()>& give_up) {
  std::unique_lock<std::mutex> lock(mutex_);
  job_ = &job;
  error_ = nullptr;
  while (job_ || running_) {
    if (job_) {
      lock.unlock();
      wake_();
      lock.lock();
    }
    // A running job uses its owner's data, so its end is always awaited.
    if (job_ || running_) done_.wait_for(lock, kJobLook);
    if (job_ && give_up()) {
      job_ = nullptr;
      return false;
    }
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return true;
}

void MainThread::do_jobs() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!job_) return;
  const std::function<void()>& job = *std::exchange(job_, nullptr);
  running_ = true;
  lock.unlock();
  std::exception_ptr error;
  try {
    job();
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  error_ = error;
  running_ = false;
  done_.notify_all();
}

}  // namespace tether::gazebo_plugin
