#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tether::raster {

/// Some threads, the caller's among them, that share the jobs of one call.
class WorkerPool {
 public:
  /// Does one job. `worker` counts from 0 and has one job at a time.
  using Job = std::function<void(int worker, int job)>;

  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return static_cast<int>(threads_.size()) + 1; }
  /// Returns when jobs 0 to count − 1 are done. Throws the first exception of a job; the rest are
  /// then left out. From one thread at a time.
  void run(int count, const Job& job);

 private:
  void serve(int worker);
  void work(int worker, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable end_;
  const Job* job_ = nullptr;
  int next_ = 0;
  int count_ = 0;
  int busy_ = 0;
  bool ends_ = false;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace tether::raster
