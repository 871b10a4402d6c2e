#include "ahead_drawer.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <tether/base/error.h>

namespace tether::sim {

AheadDrawer::AheadDrawer(int threads, Draw draw) : draw_(std::move(draw)) {
  try {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([this, i] { serve(static_cast<std::size_t>(i)); });
    }
  } catch (const std::system_error&) {
    end();
    throw Error(ErrorCode::kSetup,
                "cannot start a thread that draws images: too little memory, or too many threads");
  }
}

AheadDrawer::~AheadDrawer() {
  end();
}

void AheadDrawer::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  begin_.notify_all();
}

void AheadDrawer::expect(const PictureKey& key, const Snapshot& snapshot) {
  {
    const std::lock_guard lock(mutex_);
    const auto is_of_sensor = [&](const Job& job) {
      return job.key.uav == key.uav && job.key.sensor == key.sensor;
    };
    if (std::ranges::count_if(jobs_, is_of_sensor) >= kMostPerSensor) return;
    if (std::ranges::find(jobs_, key, &Job::key) != jobs_.end()) return;
    jobs_.push_back({.key = key, .snapshot = snapshot});
  }
  begin_.notify_one();
}

std::optional<uav::Sample> AheadDrawer::take(const PictureKey& key) {
  std::unique_lock lock(mutex_);
  for (auto job = jobs_.begin(); job != jobs_.end();) {
    const bool is_earlier =
        job->key.uav == key.uav && job->key.sensor == key.sensor && job->key.index < key.index;
    job = is_earlier ? drop(job) : std::next(job);
  }
  const auto job = std::ranges::find_if(
      jobs_, [&](const Job& other) { return other.key == key && !other.is_dropped; });
  if (job == jobs_.end()) return std::nullopt;
  if (job->state == State::kWaiting) {
    jobs_.erase(job);
    return std::nullopt;
  }
  while (job->state != State::kDone) {
    const auto other = std::ranges::find_if(jobs_, [&](const Job& waiting) {
      return waiting.state == State::kWaiting && waiting.key.at <= key.at;
    });
    if (other != jobs_.end()) {
      draw(other, threads_.size(), lock);
    } else if (Parts* const parts = open_parts()) {
      help(*parts, lock);
    } else {
      done_.wait(lock);
    }
  }
  --work_.drawn_in_vain;
  Job taken = std::move(*job);
  jobs_.erase(job);
  if (taken.failure) std::rethrow_exception(taken.failure);
  return std::move(taken.sample);
}

void AheadDrawer::reset() {
  std::unique_lock lock(mutex_);
  for (auto job = jobs_.begin(); job != jobs_.end();) job = drop(job);
  done_.wait(lock, [&] { return jobs_.empty(); });
  work_ = {};
}

SimulatorWork AheadDrawer::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

// A job that is being drawn is removed by its thread. @pre locked.
AheadDrawer::Jobs::iterator AheadDrawer::drop(Jobs::iterator job) {
  if (job->state != State::kBegun) return jobs_.erase(job);
  job->is_dropped = true;
  return std::next(job);
}

void AheadDrawer::serve(std::size_t worker) {
  std::unique_lock lock(mutex_);
  for (;;) {
    auto job = jobs_.end();
    Parts* parts = nullptr;
    begin_.wait(lock, [&] {
      job = std::ranges::find(jobs_, State::kWaiting, &Job::state);
      parts = open_parts();
      return ends_ || job != jobs_.end() || parts != nullptr;
    });
    if (ends_) return;
    if (job != jobs_.end()) {
      draw(job, worker, lock);
    } else {
      help(*parts, lock);
    }
  }
}

// No other thread touches a picture that is being drawn.
void AheadDrawer::draw(Jobs::iterator job, std::size_t worker, std::unique_lock<std::mutex>& lock) {
  job->state = State::kBegun;
  ++work_.pictures, ++work_.drawn_ahead, ++work_.drawn_in_vain;
  lock.unlock();
  const CpuTimer timer;
  try {
    job->sample = draw_(worker, job->key, job->snapshot);
  } catch (...) {
    job->failure = std::current_exception();
  }
  const Duration time = timer.elapsed();
  lock.lock();
  work_.drawing += time;
  job->state = State::kDone;
  if (job->is_dropped) jobs_.erase(job);
  done_.notify_all();
}

void AheadDrawer::share(int count, const Part& draw_part) {
  std::unique_lock lock(mutex_);
  const auto parts = parts_.insert(parts_.end(), {.draw = draw_part, .count = count});
  begin_.notify_all();
  done_.notify_all();
  draw(*parts, lock);
  done_.wait(lock, [&] { return parts->busy == 0; });
  const std::exception_ptr failure = parts->failure;
  parts_.erase(parts);
  if (failure) std::rethrow_exception(failure);
}

AheadDrawer::Parts* AheadDrawer::open_parts() {
  const auto open =
      std::ranges::find_if(parts_, [](const Parts& parts) { return parts.next < parts.count; });
  return open == parts_.end() ? nullptr : &*open;
}

// A part takes so long that one lock for each costs nothing.
void AheadDrawer::draw(Parts& parts, std::unique_lock<std::mutex>& lock) {
  while (parts.next < parts.count) {
    const int part = parts.next++;
    ++parts.busy;
    lock.unlock();
    std::exception_ptr failure;
    try {
      parts.draw(part);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --parts.busy;
    if (failure && !parts.failure) {
      parts.failure = failure;
      parts.next = parts.count;
    }
  }
  if (parts.busy == 0) done_.notify_all();
}

void AheadDrawer::help(Parts& parts, std::unique_lock<std::mutex>& lock) {
  const CpuTimer timer;
  draw(parts, lock);
  work_.drawing += timer.elapsed();
}

}  // namespace tether::sim
