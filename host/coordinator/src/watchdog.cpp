#include "watchdog.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

namespace tether::coordinator {

namespace {

// How often limits of WT are looked at.
constexpr Duration kWatchPeriod = std::chrono::milliseconds(20);
// A turn that took longer than this was not spent listening: we were stopped, say, or the whole
// machine was.
constexpr Duration kLongestTurn = std::chrono::seconds(1);
// How long nothing may move before it is said who waits for whom.
constexpr Duration kStillPeriod = std::chrono::seconds(1);

std::string missing(const std::vector<Party>& parties) {
  std::vector<std::string> uavs;
  Duration waited{0};
  for (const Party& party : parties) {
    if (party.joined) continue;
    uavs.push_back(party.uav);
    waited = std::max(waited, party.silence);
  }
  return who_has_not_joined(uavs, waited);
}

}  // namespace

bool shows_life(const link::Message& message, const Standing& sut, link::ClockKind clock) {
  if (!sut.running || !sut.tied) return true;
  if (std::holds_alternative<link::Annotation>(message)) return false;
  const auto* progress = std::get_if<link::Progress>(&message);
  if (!progress) return true;
  if (clock == link::ClockKind::kWall && sut.open_calls == 0) return false;
  return progress->reached > sut.bound;
}

Watchdog::Watchdog(const Limits& limits, std::size_t suts, bool tied, WallTime now)
    : limits_(limits), tied_(tied), last_heard_(suts, now), moved_(now), looked_(now) {}

void Watchdog::begin(WallTime now) {
  running_ = true;
  moved_ = now;
  std::fill(last_heard_.begin(), last_heard_.end(), now);
}

bool Watchdog::is_due(WallTime now) {
  if (now - looked_ < kWatchPeriod) return false;
  pardon(now - looked_ - kLongestTurn, now);
  looked_ = now;
  return true;
}

// Messages that came meanwhile are still to be read, and SUTs that were stopped together with this
// process had no time to send any.
void Watchdog::pardon(Duration unheard, WallTime now) {
  if (unheard <= Duration(0)) return;
  moved_ = std::min(moved_ + unheard, now);
  for (WallTime& heard : last_heard_) heard = std::min(heard + unheard, now);
}

std::optional<Ending> Watchdog::over_time(SimTime st) const {
  if (st < limits_.st) return std::nullopt;
  return Ending{RunEnd::kTimeLimit,
                fmt::format("ST reached the scenario's time limit of {} s before the task was done",
                            to_seconds(limits_.st))};
}

std::optional<Ending> Watchdog::overdue(const std::vector<Party>& parties, SimTime st) const {
  for (const Party& party : parties)
    if (auto end = overdue(party, parties, st)) return end;
  return std::nullopt;
}

std::optional<Ending> Watchdog::overdue(const Party& party, const std::vector<Party>& parties,
                                        SimTime st) const {
  if (!running_ && !party.joined && party.silence > limits_.connect)
    return Ending{RunEnd::kSutLost, fmt::format("no SUT joined for UAV \"{}\" within {} s",
                                                party.uav, to_seconds(limits_.connect))};
  if (running_ && party.computing && party.silence > limits_.hang)
    return Ending{
        RunEnd::kSutHung,
        fmt::format("SUT \"{}\" of UAV \"{}\" timed out: no message for {} s (hang_limit_s){}",
                    party.sut, party.uav, to_seconds(limits_.hang),
                    tied_ ? ": " + who_blocks_whom(st, parties) : "")};
  return std::nullopt;
}

std::string Watchdog::blocked(const std::vector<Party>& parties, SimTime st, WallTime now) const {
  if (now - moved_ < kStillPeriod) return "";
  if (!running_) return missing(parties);
  return tied_ ? who_blocks_whom(st, parties) : "";
}

}  // namespace tether::coordinator
