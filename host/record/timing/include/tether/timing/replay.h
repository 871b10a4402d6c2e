#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tether/computer/clock.h>
#include <tether/link/messages.h>
#include <tether/timing/timing.h>

namespace tether::timing {

struct ReplaySetting {
  computer::ReplayMode mode = computer::ReplayMode::kResampled;
  computer::UnknownStages unknown = computer::UnknownStages::kRefused;
  /// The program that flies, under a counted clock: for kScaled and UnknownStages::kCounted.
  std::optional<Timing> counted{};
  double slowdown = 1.0;  ///< all times are multiplied by it; kExact: 1
};

/// Gives one SUT its recorded time. Pure logic: what it gives depends on the calls so far only. Not
/// thread-safe.
class Replay {
 public:
  /// @throws Error(kBadFile), without a file, if the timing has no run of the UAV (kExact: and of
  /// the seed), too many stages, or a stage without counted work (kScaled).
  Replay(const Timing& timing, const ReplaySetting& setting, const std::string& uav,
         std::uint64_t seed);

  /// What each stage takes until the next call.
  const std::vector<link::StageTime>& given() const { return given_; }
  /// Takes the next call of the SUT. The difference to what was recorded, which ends the run; none
  /// if there is none.
  std::optional<std::string> take(const std::string& call,
                                  const std::vector<link::StageTime>& stages);
  /// Whether the timing has that stage.
  bool knows(const std::string& stage) const { return sources_.contains(stage); }
  /// What differs between this program and the one that was recorded; none: it can be given this
  /// time.
  std::optional<std::string> other_build(const std::string& build_id, const Build& build) const;

 private:
  /// Times of a stage to draw from.
  struct Source {
    std::vector<double> times_ns;
    double factor = 1.0;
    std::uint64_t index = 0;
  };
  void give();
  Duration draw(const std::string& stage, const Source& source) const;
  std::optional<std::string> difference(const std::string& call,
                                        const std::vector<link::StageTime>& stages) const;

  computer::UnknownStages unknown_;
  std::string uav_;
  std::uint64_t seed_;
  std::optional<Build> required_;  // kExact: the build, its build id first
  std::vector<Call> calls_;        // kExact: those that are expected
  std::size_t next_ = 0;
  std::map<std::string, Source> sources_;  // of the timing
  std::map<std::string, Source> counted_;  // of stages that it does not have
  std::vector<link::StageTime> given_;
};

}  // namespace tether::timing
