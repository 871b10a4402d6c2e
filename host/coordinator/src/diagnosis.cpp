#include "diagnosis.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tether::coordinator {

namespace {

// Everything waits for the one that is least far.
const Party* culprit(const std::vector<Party>& parties) {
  const Party* found = nullptr;
  for (const Party& party : parties)
    if (party.computing && (!found || party.bound < found->bound)) found = &party;
  return found;
}

std::string waiting(const Party& party) {
  return fmt::format("UAV \"{}\" waits for its reply of ET {:.6f} s", party.uav,
                     to_seconds(*party.reply_at));
}

}  // namespace

std::string whereabouts(const Party& party) {
  if (party.computing || !party.reply_at)
    return fmt::format("it was computing, last heard of at ET {:.6f} s", to_seconds(party.bound));
  return fmt::format("it was waiting for its reply of ET {:.6f} s", to_seconds(*party.reply_at));
}

std::string who_blocks_whom(SimTime st, const std::vector<Party>& parties) {
  const Party* blocker = culprit(parties);
  if (!blocker) return "";
  std::vector<std::string> others;
  for (const Party& party : parties)
    if (&party != blocker && party.reply_at) others.push_back(waiting(party));
  const std::string with = others.empty() ? "" : fmt::format(" ({})", fmt::join(others, ", "));
  return fmt::format(
      "ST {:.6f} s{}: blocked on SUT \"{}\" (UAV \"{}\"), which has been computing for {:.1f} s "
      "without a message; last message at ET {:.6f} s",
      to_seconds(st), with, blocker->sut, blocker->uav, to_seconds(blocker->silence),
      to_seconds(blocker->bound));
}

std::string who_has_not_joined(const std::vector<std::string>& uavs, Duration waited) {
  const bool is_one = uavs.size() == 1;
  return fmt::format("waiting for the SUT{} of \"{}\" to connect ({:.1f} s so far)",
                     is_one ? "" : "s", fmt::join(uavs, "\", \""), to_seconds(waited));
}

}  // namespace tether::coordinator
