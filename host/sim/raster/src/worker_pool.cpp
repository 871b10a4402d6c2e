#include "worker_pool.h"

#include <utility>

namespace tether::raster {

WorkerPool::WorkerPool(int workers) {
  for (int i = 1; i < workers; ++i) threads_.emplace_back([this, i] { serve(i); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  begin_.notify_all();
}

void WorkerPool::run(int count, const Job& job) {
  std::unique_lock lock(mutex_);
  job_ = &job;
  next_ = 0;
  count_ = count;
  begin_.notify_all();
  work(0, lock);
  end_.wait(lock, [this] { return busy_ == 0; });
  job_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void WorkerPool::serve(int worker) {
  std::unique_lock lock(mutex_);
  for (;;) {
    begin_.wait(lock, [this] { return ends_ || next_ < count_; });
    if (ends_) return;
    work(worker, lock);
  }
}

// Jobs are long, so that one lock for each costs nothing.
void WorkerPool::work(int worker, std::unique_lock<std::mutex>& lock) {
  while (next_ < count_) {
    const int job = next_++;
    ++busy_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*job_)(worker, job);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --busy_;
    if (failure && !failure_) {
      failure_ = failure;
      next_ = count_;
    }
  }
  if (busy_ == 0) end_.notify_all();
}

}  // namespace tether::raster
