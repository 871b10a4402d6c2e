#pragma once

#include "frames.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/count_page.h>
#include <tether/base/time.h>
#include <tether/calibration/calibration.h>

/// The work of `calibrate`, and how its time is taken.
namespace tether::calibration {

using Work = std::array<double, kWorkClasses>;

/// Clocks as parameters, so that tests need not measure.
struct Stopwatch {
  std::function<Duration()> cpu;   ///< CPU time of this process
  std::function<Duration()> wall;  ///< monotonic
  /// Under an emulator with Tether's plugin: how often each kind of work was done; else empty.
  std::function<Work()> work{};
};
/// This machine's.
Stopwatch system_stopwatch();

struct WorkloadOptions {
  int rounds = 30;  ///< that count; a round is every block on every image
  int warm_up = 3;  ///< rounds before them
};

struct MeasuredWork {
  std::vector<BlockTimes> blocks;
  std::vector<BlockTimes> kernels;  ///< of kernels.h
};

/// How what was seen differs from what must be, beyond what another build's rounding may make;
/// empty: not at all. None: the anchor was not found.
std::string difference(const std::optional<View>& seen, const View& expected);

/// Computes the blocks in turn, round by round, so that whatever changes meanwhile (heat, load)
/// meets all of them:
///   prefilter        median of 9 × 9 pixels, as the tasks' scenarios have it
///   back_projection  HSV, hue histogram, mask
///   tracking         CamShift from the last window, and the anchor's edges
///   search           the same in the whole image, without a last window
///   position         bearing and distance
///   perception       an image's whole way: prefilter to position
/// and then the kernels.
/// Fails (kInvalid) with one line where what it sees is not what every machine must see: such times
/// are of other work.
Result<MeasuredWork> run_workload(const WorkloadOptions& options, const Stopwatch& stopwatch,
                                  const TellRound& tell = {});

}  // namespace tether::calibration
