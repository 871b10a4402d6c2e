#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/simulator.h>
#include <tether/sim_raster/renderer.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// A measurement of a camera.
struct PictureKey {
  std::size_t uav = 0;
  std::size_t sensor = 0;
  std::uint64_t index = 0;
  SimTime at;  ///< of the snapshot

  friend bool operator==(const PictureKey&, const PictureKey&) = default;
};

/// Draws pictures on threads of its own before they are asked for. A thread without a picture
/// helps to draw those of others. Its functions, but for those of Helpers, are called from one
/// thread at a time. The destructor waits for pictures that are being drawn.
class AheadDrawer final : public raster::Helpers {
 public:
  /// Draws the picture of a snapshot on thread `worker` (0, 1, …; after the last, the thread that
  /// calls `take`). Called by several threads, with different workers.
  using Draw =
      std::function<uav::Sample(std::size_t worker, const PictureKey&, const Snapshot& snapshot)>;
  /// Pictures of one sensor that are kept; an image may have 200 MB.
  static constexpr int kMostPerSensor = 2;

  /// @pre `threads` ≥ 1. @throws Error(kSetup) when a thread cannot be started.
  AheadDrawer(int threads, Draw draw);
  ~AheadDrawer() override;

  /// Draws this picture as soon as a thread is free. Does nothing if the picture is known, or if
  /// `kMostPerSensor` of its sensor are.
  void expect(const PictureKey& key, const Snapshot& snapshot);
  /// The picture. If it is being drawn, waits for it, and meanwhile draws others of snapshots that
  /// are not later, or helps. None if no thread has begun to draw it; then none will. Drops earlier
  /// pictures of the sensor, in vain. @throws what `Draw` threw for it.
  std::optional<uav::Sample> take(const PictureKey& key);
  /// Drops every picture, and waits until no thread draws; counts from 0 again.
  void reset();
  /// What the threads have drawn. A picture that can still be taken counts as in vain.
  SimulatorWork work() const;

  int threads() const override { return static_cast<int>(threads_.size()); }
  void share(int count, const Part& draw) override;

 private:
  enum class State { kWaiting, kBegun, kDone };
  struct Job {
    PictureKey key;
    Snapshot snapshot;
    State state = State::kWaiting;
    bool is_dropped = false;  // while it is being drawn
    uav::Sample sample{};
    std::exception_ptr failure{};
  };
  using Jobs = std::list<Job>;
  /// The parts of a picture that a thread draws.
  struct Parts {
    const Part& draw;
    int count;
    int next = 0;
    int busy = 0;
    std::exception_ptr failure{};
  };

  void end();
  void serve(std::size_t worker);
  void draw(Jobs::iterator job, std::size_t worker, std::unique_lock<std::mutex>& lock);
  Jobs::iterator drop(Jobs::iterator job);
  Parts* open_parts();
  void draw(Parts& parts, std::unique_lock<std::mutex>& lock);
  void help(Parts& parts, std::unique_lock<std::mutex>& lock);

  const Draw draw_;
  mutable std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable done_;
  Jobs jobs_;
  std::list<Parts> parts_;
  SimulatorWork work_;
  bool ends_ = false;
  std::vector<std::jthread> threads_;  // last: ends before what it uses
};

}  // namespace tether::sim
