#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tether/base/result.h>
#include <tether/base/time.h>

/// What a SUT runs on, and how its execution time is known (DESIGN section 2, "How a SUT's time is
/// measured"). Everything that asks what a clock can do asks here: a new clock is an enumerator, a
/// row of the table in clock.cpp, and the source that reads it (target/client).
namespace tether::computer {

/// The values are those of the link's messages.
enum class ClockKind : std::uint8_t {
  kWall = 0,       ///< the machine's monotonic clock
  kCpu = 1,        ///< CPU time of the program and of its descendants
  kScripted = 2,   ///< each phase of computing takes the same time
  kUnstamped = 3,  ///< timed by the coordinator
  kCounted = 4,    ///< counted work × its costs
  kReplayed = 5,   ///< recorded earlier, by stage
};
inline constexpr std::size_t kClockKinds = 6;

/// As users write it: "wall", "cpu", "scripted", "unstamped", "counted", "replayed"; of another
/// value "unknown".
std::string_view name(ClockKind kind);
/// The inverse; none for other texts.
std::optional<ClockKind> clock_kind(std::string_view name);

/// A clock with its rate.
struct Clock {
  ClockKind kind = ClockKind::kWall;
  /// Of kWall and kCpu: seconds of ET per second that the clock measures; > 0.
  double factor = 1.0;
  Duration computing{0};  ///< of kScripted: ET of each phase of computing

  /// In the syntax of TETHER_CLOCK: "cpu*6", "scripted*2.5" (milliseconds), "counted".
  std::string text() const;
  /// Runs repeat to the byte: no clock of a machine has a part in it.
  bool repeats() const;
  /// Works for a program of which several threads or processes call in parallel.
  bool allows_parallel() const;
  /// Goes on while the program waits for something that is no interaction.
  bool counts_waiting() const;
  /// The same, and no factor makes more of it, as it does of computing.
  bool counts_waiting_as_it_is() const { return counts_waiting() && !is_scaled(); }
  /// Grows by the time of every core on which the program and its descendants compute.
  bool adds_up_cores() const { return kind == ClockKind::kCpu; }
  /// Cannot be used in free running, where ST follows the real wall clock.
  bool needs_barrier() const;
  /// The clock of a machine that is several times slower or faster: a factor that is not 1.
  bool is_scaled() const { return factor != 1.0; }

  friend bool operator==(const Clock&, const Clock&) = default;
};

/// The least and the largest factor, and ET of a scripted phase of computing in milliseconds.
inline constexpr double kLeastRate = 1e-6, kLargestRate = 1e6;

/// The inverse of Clock::text(); a factor of 1 may be left out. Fails with kInvalid and what is
/// allowed.
Result<Clock> parse_clock(const std::string& text);

/// How recorded time is charged.
enum class ReplayMode {
  kExact,      ///< each call gets the times that it had in the run of the same UAV and seed
  kResampled,  ///< drawn from the times of the stage, keyed by seed, UAV, stage and index
  kScaled,     ///< the same × counted work of the new build / of the one that was recorded
};
/// In the order of ReplayMode.
inline constexpr std::array<std::string_view, 3> kReplayModes = {"exact", "resampled", "scaled"};

/// What stages are charged that the timing does not have.
enum class UnknownStages {
  kRefused,  ///< they end the run
  kCounted,  ///< drawn from their times under a counted clock
  kZero,
};
/// In the order of UnknownStages.
inline constexpr std::array<std::string_view, 3> kUnknownStages = {"refused", "counted", "zero"};

}  // namespace tether::computer
