#include "workload.h"

#include "frames.h"
#include "kernels.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include <tether/base/text.h>
#include <tether/base/units.h>
#include <tether/os/counted_program.h>
#include <tether/os/machine.h>
#include <tether/vision/anchor_tracker.h>

// Computes the measured work: each round runs every block of the vision tasks on every embedded
// image, and BlockClock adds the time of each block. The result of the whole step is compared with
// the expected one, so that only equal work is compared between machines.
namespace tether::calibration {
namespace {

/// Bearing and distance take so little that one alone is below what a clock can tell.
constexpr int kPositionsPerImage = 2000;

vision::TrackerOptions tracker_options() {
  vision::TrackerOptions options;
  options.prefilter = vision::Prefilter::kMedian;
  options.prefilter_size_px = 9;
  return options;
}

/// Adds the time of one block, over all images of a round.
class BlockClock {
 public:
  BlockClock(const Stopwatch& stopwatch, std::string name, int repetitions = 1)
      : stopwatch_(stopwatch), repetitions_(repetitions) {
    times_.name = std::move(name);
  }

  template <class Function>
  void time(const Function& work) {
    const Duration cpu = stopwatch_.cpu(), wall = stopwatch_.wall();
    const Work before = counted();
    work();
    const Work after = counted();
    cpu_ += stopwatch_.cpu() - cpu;
    wall_ += stopwatch_.wall() - wall;
    for (std::size_t kind = 0; kind < work_.size(); ++kind)
      work_[kind] += after[kind] - before[kind];
  }

  void end_round(std::size_t images, bool counts) {
    const double times = static_cast<double>(images) * repetitions_;
    if (counts) {
      times_.cpu_ms.push_back(1e3 * to_seconds(cpu_) / times);
      times_.wall_ms.push_back(1e3 * to_seconds(wall_) / times);
      if (stopwatch_.work) {
        times_.work.resize(kWorkClasses);
        // The mean of the rounds so far.
        const double share = 1.0 / static_cast<double>(times_.cpu_ms.size());
        for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
          times_.work[kind] += share * (work_[kind] / times - times_.work[kind]);
      }
    }
    cpu_ = wall_ = Duration(0);
    work_ = {};
  }

  BlockTimes take() { return std::move(times_); }

 private:
  Work counted() const { return stopwatch_.work ? stopwatch_.work() : Work{}; }

  const Stopwatch& stopwatch_;
  int repetitions_;
  BlockTimes times_;
  Duration cpu_{0}, wall_{0};
  Work work_{};
};

std::string in_words(const View& view) {
  return fixed(view.width_px, 3) + " x " + fixed(view.height_px, 3) + " px at " +
         fixed(view.u_px, 3) + ", " + fixed(view.v_px, 3) + ", " + fixed(view.bearing_deg, 3) +
         " deg, " + fixed(view.distance_m, 3) + " m";
}

class Workload {
 public:
  Workload(std::vector<uav::CameraSample> frames, vision::AnchorTracker tracker,
           const Stopwatch& stopwatch)
      : frames_(std::move(frames)),
        tracker_(std::move(tracker)),
        prefilter_(stopwatch, "prefilter"),
        back_projection_(stopwatch, "back_projection"),
        tracking_(stopwatch, "tracking"),
        search_(stopwatch, "search"),
        position_(stopwatch, "position", kPositionsPerImage),
        perception_(stopwatch, kWholeStep) {
    for (const Kernel& kernel : kernels()) kernels_.emplace_back(stopwatch, kernel.name);
  }

  Status run_round(bool counts) {
    for (const uav::CameraSample& frame : frames_) step_by_step(frame);
    tracker_.reset();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      std::optional<View> view;
      perception_.time([&] { view = perceive(frames_[i]); });
      if (const std::string wrong = difference(view, expected_views()[i]); !wrong.empty()) {
        return Failure{Failure::Kind::kInvalid,
                       "this machine computes other results, so its times cannot be compared: in "
                       "image " +
                           std::to_string(i + 1) + ", " + wrong};
      }
    }
    for (BlockClock* clock : clocks()) clock->end_round(frames_.size(), counts);
    for (std::size_t i = 0; i < kernels_.size(); ++i) {
      kernels_[i].time(kernels()[i].run);
      kernels_[i].end_round(1, counts);
    }
    return ok_status();
  }

  MeasuredWork take() {
    MeasuredWork measured;
    for (BlockClock* clock : clocks()) measured.blocks.push_back(clock->take());
    for (BlockClock& clock : kernels_) measured.kernels.push_back(clock.take());
    return measured;
  }

 private:
  std::vector<BlockClock*> clocks() {
    return {&prefilter_, &back_projection_, &tracking_, &search_, &position_, &perception_};
  }

  void step_by_step(const uav::CameraSample& frame) {
    std::optional<vision::Roi> roi;
    prefilter_.time([&] { tracker_.prefilter(frame); });
    back_projection_.time([&] { tracker_.back_project(); });
    tracker_.reset();
    search_.time([&] { roi = tracker_.locate(); });
    tracking_.time([&] { roi = tracker_.locate(); });
    if (!roi) return;
    position_.time([&] {
      for (int n = 0; n < kPositionsPerImage; ++n) {
        // Written where the compiler must leave it.
        bearing_rad_ = vision::relative_position(camera_, anchor_, *roi).bearing_rad;
      }
    });
  }

  std::optional<View> perceive(const uav::CameraSample& frame) {
    const std::optional<vision::Roi> roi = tracker_.track(frame);
    if (!roi) return std::nullopt;
    const vision::RelativePosition position = vision::relative_position(camera_, anchor_, *roi);
    return View{roi->center.u_px,
                roi->center.v_px,
                roi->width_px,
                roi->height_px,
                deg_from_rad(position.bearing_rad),
                position.distance_m.value_or(NAN)};
  }

  const std::vector<uav::CameraSample> frames_;
  vision::AnchorTracker tracker_;
  const uav::SensorDescription camera_ = calibration_camera();
  const uav::Anchor anchor_ = calibration_anchor();
  BlockClock prefilter_, back_projection_, tracking_, search_, position_, perception_;
  std::vector<BlockClock> kernels_;
  volatile double bearing_rad_ = 0.0;
};

}  // namespace

std::string difference(const std::optional<View>& seen, const View& expected) {
  constexpr double kTolerance_px = 0.05, kTolerance_deg = 0.02, kTolerance_m = 0.01;
  if (!seen) return "the anchor was not found";
  const auto is_near = [](double a, double b, double tolerance) {
    return std::abs(a - b) <= tolerance;
  };
  const bool is_same = is_near(seen->u_px, expected.u_px, kTolerance_px) &&
                       is_near(seen->v_px, expected.v_px, kTolerance_px) &&
                       is_near(seen->width_px, expected.width_px, kTolerance_px) &&
                       is_near(seen->height_px, expected.height_px, kTolerance_px) &&
                       is_near(seen->bearing_deg, expected.bearing_deg, kTolerance_deg) &&
                       is_near(seen->distance_m, expected.distance_m, kTolerance_m);
  return is_same ? "" : "the anchor is " + in_words(*seen) + " instead of " + in_words(expected);
}

Stopwatch system_stopwatch() {
  Stopwatch stopwatch{[] { return os::read_clock(CLOCK_PROCESS_CPUTIME_ID); },
                      [] { return os::read_clock(CLOCK_MONOTONIC); }};
  if (const char* file = std::getenv("TETHER_COUNTS")) {
    // Shared, because a std::function is copied.
    if (const std::shared_ptr<CountPage> page = os::map_counts(file))
      stopwatch.work = [page] {
        Work work{};
        for (std::size_t kind = 0; kind < kWorkClasses; ++kind)
          work[kind] = static_cast<double>(page->counts[kind].load());
        return work;
      };
  }
  return stopwatch;
}

Result<MeasuredWork> run_workload(const WorkloadOptions& options, const Stopwatch& stopwatch,
                                  const TellRound& tell) {
  vision::set_threads(1);
  Result<std::vector<uav::CameraSample>> frames = calibration_frames();
  if (!frames) return frames.failure();
  auto tracker = vision::AnchorTracker::create(calibration_anchor(), tracker_options());
  if (!tracker) return tracker.failure();
  Workload workload(std::move(frames).value(), std::move(tracker).value(), stopwatch);
  for (int round = 1 - options.warm_up; round <= options.rounds; ++round) {
    if (tell) {
      tell(round > 0 ? "round " + std::to_string(round) + " of " + std::to_string(options.rounds)
                     : "warming up");
    }
    if (const Status same = workload.run_round(round > 0); !same) return same.failure();
  }
  return workload.take();
}

}  // namespace tether::calibration
