#pragma once

#include <ctime>
#include <functional>
#include <optional>
#include <vector>

#include <tether/campaign/result.h>
#include <tether/os/machine.h>

namespace tether::runner {

/// What the watch reads of this machine.
struct MachineReader {
  std::function<Duration()> time_block;  ///< how long a fixed block of work takes
  std::function<std::optional<os::ProcessorTime>()> processors;
  std::function<Duration()> own;  ///< CPU time of this process and its descendants
};
/// Of this machine. `clock`: in whose time a block is measured.
MachineReader machine_reader(clockid_t clock);

/// Watches how busy this machine is during a run, from the outside: a fixed block of work is timed
/// before and after the run, which takes 50 ms, and now and then during it, which takes 1 % of a
/// core. Not thread-safe.
class MachineWatch {
 public:
  /// Before the SUTs are started. Measures.
  explicit MachineWatch(MachineReader reader);
  /// During the run, as often as one likes. Measures if it is time.
  void during_run(WallTime now);
  /// At the end of the run, while its processes still exist.
  void end_of_run();
  /// After they have ended. Measures. `knows_programs`: false if the user started programs of the
  /// run, which could not be told from others.
  campaign::MachineLoad load(bool knows_programs);

 private:
  MachineReader reader_;
  std::vector<Duration> before_, during_;
  WallTime last_{};
  std::optional<os::ProcessorTime> processors_;
  Duration own_{0};
  double others_ = 0.0;
};

/// Of a machine whose state was read before and after a run. If a board was throttled, its times
/// cannot be trusted, and `reason` says so. For the host, whose times need not be its own, that is
/// a warning.
campaign::TargetReport report_of(const record::TargetInfo& info, const record::Readings& after,
                                 std::string& reason);

/// Of a board, from its readings. None: this is the host, or the board does not tell.
std::optional<campaign::MachineLoad> load_of_board(const campaign::TargetReport& target);

/// None: the machine was idle and even enough for times of that kind.
/// @param counts_turns whether the times contain what other programs took: those of a wall clock do
std::optional<campaign::Doubt> doubt_of(const campaign::MachineLoad& load, bool counts_turns);

}  // namespace tether::runner
