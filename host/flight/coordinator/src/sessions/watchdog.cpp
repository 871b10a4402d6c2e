#include "sessions/watchdog.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tether::coordinator {

namespace {

// How often limits of WT are checked.
constexpr Duration kWatchPeriod = std::chrono::milliseconds(20);
// A turn longer than this means that the process or the machine was stopped.
constexpr Duration kLongestTurn = std::chrono::seconds(1);
// How long nothing may move before it is reported.
constexpr Duration kStillPeriod = std::chrono::seconds(1);

std::string describe_missing(const std::vector<Party>& parties) {
  std::vector<std::string> uavs;
  Duration waited{0};
  for (const Party& party : parties) {
    if (party.joined) continue;
    uavs.push_back(party.uav);
    waited = std::max(waited, party.silence);
  }
  if (waited < kStillPeriod) return "";
  return fmt::format("waiting for the SUT{} of \"{}\" to connect ({:.1f} s so far)",
                     uavs.size() == 1 ? "" : "s", fmt::join(uavs, "\", \""), to_seconds(waited));
}

const char* sign_of_life(const Party& party) {
  return party.counted ? "message or counted work" : "message";
}

}  // namespace

std::string describe_state(const Party& party) {
  if (party.computing || !party.reply_at)
    return fmt::format("it was computing; last message at ET {:.6f} s",
                       to_seconds(party.bound.value_or(ExecTime{})));
  return fmt::format("it was waiting for its reply at ET {:.6f} s", to_seconds(*party.reply_at));
}

// ST waits for the computing SUT with the smallest ET.
std::string describe_blocking(SimTime st, const std::vector<Party>& parties) {
  const Party* blocker = nullptr;
  std::vector<std::string> waiting;
  for (const Party& party : parties) {
    if (party.computing && party.bound && (!blocker || party.bound < blocker->bound))
      blocker = &party;
    if (!party.computing && party.reply_at)
      waiting.push_back(fmt::format("UAV \"{}\" waits for its reply at ET {:.6f} s", party.uav,
                                    to_seconds(*party.reply_at)));
  }
  if (!blocker) return "";
  return fmt::format(
      "ST {:.6f} s{}: blocked on SUT \"{}\" (UAV \"{}\"{}), which has been {} for {:.1f} s "
      "without a {}; last message at ET {:.6f} s",
      to_seconds(st), waiting.empty() ? "" : fmt::format(" ({})", fmt::join(waiting, ", ")),
      blocker->sut, blocker->uav,
      blocker->computer.empty() ? "" : fmt::format(" on \"{}\"", blocker->computer),
      blocker->received_bytes == 0
          ? "computing"
          : fmt::format("waiting for the rest of its reply (received {} bytes)",
                        blocker->received_bytes),
      to_seconds(blocker->silence), sign_of_life(*blocker), to_seconds(*blocker->bound));
}

bool shows_life(const link::Message& message, const Standing& sut, computer::ClockKind clock) {
  if (!sut.bound) return true;
  if (std::holds_alternative<link::Annotation>(message)) return false;
  const auto* progress = std::get_if<link::Progress>(&message);
  if (!progress) return true;
  if (progress->received_bytes > 0) return progress->received_bytes > sut.received_bytes;
  if (clock == computer::ClockKind::kWall && sut.open_calls == 0) return false;
  return progress->reached > *sut.bound;
}

Watchdog::Watchdog(const Limits& limits, std::size_t suts, WallTime now)
    : limits_(limits), last_heard_(suts, now), moved_(now), checked_(now) {}

void Watchdog::begin(WallTime now) {
  running_ = true;
  moved_ = now;
  std::fill(last_heard_.begin(), last_heard_.end(), now);
}

bool Watchdog::is_due(WallTime now) {
  if (now - checked_ < kWatchPeriod) return false;
  discount(now - checked_ - kLongestTurn, now);
  checked_ = now;
  return true;
}

// Messages that arrived in that time are still to be read, and SUTs that were stopped together with
// this process could not send any.
void Watchdog::discount(Duration unwatched, WallTime now) {
  if (unwatched <= Duration(0)) return;
  moved_ = std::min(moved_ + unwatched, now);
  for (WallTime& heard : last_heard_) heard = std::min(heard + unwatched, now);
}

std::optional<Ending> Watchdog::over_time(SimTime st) const {
  if (st < limits_.st) return std::nullopt;
  return Ending{RunEnd::kTimeLimit,
                fmt::format("ST reached the scenario's time limit of {} s before the task was done",
                            to_seconds(limits_.st))};
}

std::optional<Ending> Watchdog::overdue(const std::vector<Party>& parties, SimTime st) const {
  for (const Party& party : parties) {
    if (!running_ && !party.joined && party.silence > limits_.connect)
      return Ending{
          RunEnd::kSutLost,
          fmt::format("the SUT of UAV \"{}\" did not connect within {} s "
                      "(connect_limit_s). {}",
                      party.uav, to_seconds(limits_.connect),
                      party.as_is ? "A script has to start the program with 'exec', and must "
                                    "not remove LD_PRELOAD"
                                  : "A SUT calls tether_connect() to connect")};
    if (!running_ || !party.computing || party.silence <= limits_.hang) continue;
    const std::string blocking = describe_blocking(st, parties);
    return Ending{
        RunEnd::kSutHung,
        fmt::format("SUT \"{}\" of UAV \"{}\" timed out: no {} for {} s (hang_limit_s){}{}",
                    party.sut, party.uav, sign_of_life(party), to_seconds(limits_.hang),
                    blocking.empty() ? "" : ": ", blocking)};
  }
  return std::nullopt;
}

std::string Watchdog::blocked(const std::vector<Party>& parties, SimTime st, WallTime now) const {
  if (now - moved_ < kStillPeriod) return "";
  if (!running_) return describe_missing(parties);
  // A counted SUT sends nothing while it computes, and its work is a sign of life.
  const auto computes = [](const Party& party) {
    return party.counted && party.computing && party.silence < kStillPeriod;
  };
  if (std::any_of(parties.begin(), parties.end(), computes)) return "";
  return describe_blocking(st, parties);
}

}  // namespace tether::coordinator
