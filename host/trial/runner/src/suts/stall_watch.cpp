#include "suts/stall_watch.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tether/os/machine.h>
#include <tether/os/process_table.h>

namespace tether::runner {

namespace {

constexpr Duration kAskPeriod = std::chrono::seconds(1);
// Checks come some tens of times a second.
constexpr Duration kLongestPause = std::chrono::seconds(2);
// The two clocks cannot be read at the same instant.
constexpr Duration kClockError = std::chrono::milliseconds(50);

}  // namespace

HostClocks host_clocks() {
  return {WallTime(os::read_clock(CLOCK_MONOTONIC)), WallTime(os::read_clock(CLOCK_BOOTTIME))};
}

std::optional<pid_t> stopped_process(pid_t group) {
  for (const pid_t number : os::all_processes()) {
    const auto process = os::process_stat(number);
    if (process && process->group == group && (process->state == 'T' || process->state == 't'))
      return number;
  }
  return std::nullopt;
}

StallWatch::StallWatch(std::function<std::optional<std::string>()> stopped_sut, HostClocks now)
    : stopped_sut_(std::move(stopped_sut)), began_(now), last_check_(now.running) {}

std::string StallWatch::check(const coordinator::RunStatus& status, HostClocks now) {
  const Duration pause = now.running - std::exchange(last_check_, now.running);
  if (pause > kLongestPause)
    notes_.push_back(fmt::format(
        "the coordinator stalled for {:.1f} s up to ST {:.3f} s: stopped, short of processor "
        "time, or waiting for its simulator",
        to_seconds(pause), to_seconds(status.st)));
  const bool is_new = !status.blocked.empty() && !stalled_;
  stalled_ = !status.blocked.empty();
  std::string stopped;
  if (stalled_ && (is_new || now.running - last_asked_ >= kAskPeriod)) {
    last_asked_ = now.running;
    stopped = find_stopped_sut(status);
  }
  return is_new ? status.blocked + stopped : "";
}

std::string StallWatch::find_stopped_sut(const coordinator::RunStatus& status) {
  const auto stopped = stopped_sut_();
  if (!stopped) return "";
  const std::string note = fmt::format("{} at ST {:.6f} s", *stopped, to_seconds(status.st));
  if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  if (stopped_program_.empty()) stopped_program_ = note;
  return "; " + *stopped;
}

std::vector<std::string> StallWatch::notes(HostClocks now) const {
  std::vector<std::string> notes = notes_;
  const Duration suspended = (now.since_boot - began_.since_boot) - (now.running - began_.running);
  if (suspended > kClockError)
    notes.push_back(fmt::format("this machine was suspended for {:.1f} s during the run",
                                to_seconds(suspended)));
  return notes;
}

}  // namespace tether::runner
