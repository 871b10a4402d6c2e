#include "checks.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

// Each command is matched with its effect by UAV and sequence (rule 2). Then one pass over the
// replies in the order of the file checks that every command that was due is in effect (rule 3).
namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Interaction;
using record::Logged;

// Of a UAV that is not in the header, which is a finding of its own.
const record::SutInfo kUnknown;

// All commands and all effects of one SUT, by sequence.
struct Row {
  std::vector<const Logged<Interaction>*> commands;
  std::vector<const Logged<CommandEffect>*> effects;
  std::uint64_t last_sequence = 0;  // of any interaction
  const record::SutInfo* info = &kUnknown;
};

// A command with an effect time, and its effect in the file.
struct Due {
  const Logged<Interaction>* command = nullptr;
  const Logged<CommandEffect>* effect = nullptr;  // nullptr: none
  Wide effect_at = 0;
};

bool has_setpoints(const Interaction& m) {
  return m.command.has_value() || !m.setpoints.empty();
}

// Joints alone leave what is flown.
constexpr std::uint64_t kJointsAlone = 512;
bool flies(const Interaction& command) {
  return command.setpoints.empty() || command.setpoints.front().mask != kJointsAlone;
}
bool flies(const CommandEffect& effect) {
  return !effect.setpoint || effect.setpoint->mask != kJointsAlone;
}

// Of a set-point that is a velocity in the heading frame.
std::optional<record::VelocityCommand> velocity_of(const record::Setpoint& m) {
  constexpr std::uint64_t kVelocity = 2, kYawRate = 16;
  if (!m.in_heading || (m.mask | kYawRate) != (kVelocity | kYawRate)) return std::nullopt;
  const auto& [x, y, z] = m.velocity_m_s;
  return record::VelocityCommand{x, y, z, (m.mask & kYawRate) != 0 ? m.yaw_rate_rad_s : 0.0};
}

// Whether an effect is that set-point of its command.
bool is_asked(const CommandEffect& effect, const Interaction& command) {
  if (command.command)
    return effect.index == 0 && !effect.setpoint && effect.command() == *command.command;
  if (effect.index >= command.setpoints.size()) return false;
  record::Setpoint asked = command.setpoints[effect.index];
  asked.after = Duration(0);
  return effect.setpoint == asked || (!effect.setpoint && velocity_of(asked) == effect.command());
}

template <class Message>
std::uint64_t sequence_of(const Logged<Message>* entry) {
  return entry->message.sequence;
}

// The place of an effect among those of a SUT: a loss comes after the last set-point.
std::tuple<std::uint64_t, bool, std::uint64_t> place_of(const Logged<CommandEffect>* effect) {
  const CommandEffect& m = effect->message;
  return {m.sequence, !m.loss.empty(), m.index};
}

// Rule 2: a SUT's set-points take effect in the order in which it gave them, each once; those of
// joints alone for themselves. Leaves the effects sorted by sequence.
void check_effect_order(Row& row, Report& report) {
  const Logged<CommandEffect>* last[2] = {};
  for (const Logged<CommandEffect>* effect : row.effects) {
    const Logged<CommandEffect>*& before = last[flies(effect->message) ? 1 : 0];
    if (before != nullptr && place_of(effect) <= place_of(before))
      report.add(2, *effect, "effect after that of command {} of the same SUT",
                 sequence_of(before));
    before = effect;
  }
  std::ranges::stable_sort(row.effects, {}, place_of);
}

std::vector<Due> match(Row& row, Report& report) {
  std::vector<Due> due;
  auto effect = row.effects.begin();
  for (const Logged<Interaction>* command : row.commands) {
    effect = std::ranges::lower_bound(effect, row.effects.end(), sequence_of(command), {},
                                      sequence_of<CommandEffect>);
    const auto& effect_at = command->message.effect_at;
    Due item{command, nullptr, wide(effect_at.value_or(SimTime{}))};
    if (effect != row.effects.end() && sequence_of(*effect) == sequence_of(command)) {
      item.effect = *effect;
      if (effect_at && (*effect)->message.applied_at != *effect_at)
        report.add(2, **effect, "effect at ST {} instead of ST {}",
                   ns((*effect)->message.applied_at), ns(*effect_at));
    }
    if (effect_at) due.push_back(item);
  }
  return due;
}

/// What follows the first set-point of a command: the others, and a loss of the link.
struct Later {
  Wide at;  // exact
  std::tuple<std::uint64_t, bool, std::uint64_t> place;
};

std::vector<Later> later_of(const Interaction& command, const record::SutInfo& sut) {
  const Wide arrival = arrival_of(command, sut);
  std::vector<Later> later;
  for (std::size_t i = 1; i < command.setpoints.size(); ++i)
    later.push_back({arrival + wide(command.setpoints[i].after), {command.sequence, false, i}});
  if (sut.setpoint_timeout <= Duration(0)) return later;
  // A command at the timeout is in time.
  const std::size_t last = std::max<std::size_t>(command.setpoints.size(), 1) - 1;
  const Wide begin = last > 0 ? later.back().at : arrival;
  later.push_back({begin + wide(sut.setpoint_timeout) + 1, {command.sequence, true, last}});
  return later;
}

// Rule 2: the set-points of a trajectory after its first one, and losses of the link, take effect
// when they are due, unless the next command arrives before. The next one after the last command of
// the record may be one whose reply was still held.
void check_later(const Row& row, const Boundaries& grid, bool finished, Wide end, Report& report) {
  std::vector<const Logged<Interaction>*> flown;
  std::ranges::copy_if(row.commands, std::back_inserter(flown),
                       [](const auto* command) { return flies(command->message); });
  for (auto command = flown.begin(); command != flown.end(); ++command) {
    const auto next = std::next(command);
    const bool is_last = next == flown.end();
    for (const auto& [at, place] : later_of((*command)->message, *row.info)) {
      const Wide due = grid.at_or_after(at);
      const bool is_due = is_last ? finished && due < end
                                  : at <= arrival_of((*next)->message, *row.info) && due < end;
      const bool may_be = is_last || at <= arrival_of((*next)->message, *row.info);
      const auto found = std::ranges::lower_bound(row.effects, place, {}, place_of);
      const bool is_there = found != row.effects.end() && place_of(*found) == place;
      if (!is_there && is_due)
        report.add(2, **command, "a set-point or loss due at ST {} has no effect", ns(due));
      if (is_there && (!may_be || wide((*found)->message.applied_at) != due))
        report.add(
            2, **found, "effect at ST {}; {}", ns((*found)->message.applied_at),
            may_be ? fmt::format("it is due at ST {}", ns(due)) : "the next command was there");
    }
  }
}

// Rule 2: no effect without its command. The one exception is a command whose reply was still held
// when the record ended: for a serial SUT the one after its last; for a concurrent SUT any, but
// only at the last ST, which does not advance while a reply is held.
void check_orphans(const Row& row, bool finished, Wide end, Report& report) {
  for (const Logged<CommandEffect>* effect : row.effects) {
    const bool has_command =
        std::ranges::binary_search(row.commands, sequence_of(effect), {}, sequence_of<Interaction>);
    const bool held_at_end =
        !finished && (row.info->concurrent ? wide(effect->message.applied_at) >= end
                                           : sequence_of(effect) == row.last_sequence + 1);
    if (!has_command && !held_at_end)
      report.add(2, *effect, "effect without a command of that sequence number");
  }
}

// Rule 3: when a reply is released, every command with an earlier timestamp that is due has been
// applied, and the simulator had it before the reply was sent. A missing command is reported at the
// first release that should have waited for it.
void check_releases(const record::Record& record, std::vector<Due>& due, Report& report) {
  std::ranges::stable_sort(due, {}, &Due::effect_at);
  std::vector<Due> outstanding;
  auto next = due.begin();
  Wide st = 0;
  for (const Logged<Interaction>& release : record.interactions) {
    st = std::max(st, wide(release.message.st_at_release));
    for (; next != due.end() && next->effect_at <= st; ++next) outstanding.push_back(*next);
    std::erase_if(outstanding, [&](const Due& item) {
      if (item.effect != nullptr && item.effect->order < release.order) return true;
      if (item.command->message.request_at >= release.message.reply_at ||
          item.effect_at > wide(release.message.st_at_release))
        return false;
      report.add(3, release,
                 "reply at ST {} before command {} of \"{}\", due at ST {}, was applied",
                 ns(release.message.st_at_release), sequence_of(item.command),
                 item.command->message.uav, ns(item.effect_at));
      return true;
    });
  }
}

// Rule 2: every command that was due within the run took effect.
void check_missing(const std::vector<Due>& due, Wide end, Report& report) {
  for (const Due& item : due) {
    if (item.effect == nullptr && item.effect_at < end)
      report.add(2, *item.command, "command due at ST {} has no effect, and ST reached {}",
                 ns(item.effect_at), ns(end));
  }
}

// ST that the run is known to have reached.
Wide end_of(const record::Record& record) {
  if (record.footer) return wide(record.footer->st_at_end);
  return record.interactions.empty() ? Wide{0} : wide(record.interactions.back().at);
}

}  // namespace

Wide arrival_of(const Interaction& command, const record::SutInfo& sut) {
  return wide(command.request_at) + wide(command.command_latency.value_or(sut.command_latency));
}

void check_setpoints(const record::Record& record, Report& report) {
  std::map<std::pair<std::string, std::uint64_t>, const Interaction*> asked;
  std::map<std::string, std::string> on_loss;
  for (const record::SutInfo& sut : record.header.suts)
    if (sut.setpoint_timeout > Duration(0)) on_loss[sut.uav] = sut.on_setpoint_loss;
  for (const Logged<Interaction>& entry : record.interactions)
    if (has_setpoints(entry.message))
      asked[{entry.message.uav, entry.message.sequence}] = &entry.message;
  if (asked.empty() && record.header.time_limit <= Duration(0)) return;  // Tether 0.1.0
  for (const Logged<Interaction>& entry : record.interactions)
    if (has_setpoints(entry.message) != (entry.message.kind == record::kCommand))
      report.add(0, entry, "a {} {} a set-point", entry.message.kind,
                 has_setpoints(entry.message) ? "with" : "without");
  for (const Logged<CommandEffect>& effect : record.commands) {
    const CommandEffect& m = effect.message;
    if (!m.loss.empty() && m.loss != on_loss[m.uav])
      report.add(2, effect, "the loss of the link has the effect \"{}\", not \"{}\"", m.loss,
                 on_loss[m.uav]);
    const auto found = asked.find({m.uav, m.sequence});
    const bool is_own = m.loss.empty() || m.loss == "keep";
    if (is_own && found != asked.end() && !is_asked(m, *found->second))
      report.add(2, effect, "what takes effect is not what command {} asked for", m.sequence);
  }
}

void check_commands(const record::Record& record, const Boundaries& grid, Report& report) {
  std::map<std::string, Row> rows;
  for (const record::SutInfo& sut : record.header.suts) rows[sut.uav].info = &sut;
  for (const Logged<Interaction>& entry : record.interactions) {
    Row& row = rows[entry.message.uav];
    row.last_sequence = std::max(row.last_sequence, entry.message.sequence);
    if (entry.message.kind == record::kCommand) row.commands.push_back(&entry);
  }
  for (const Logged<CommandEffect>& effect : record.commands) {
    rows[effect.message.uav].effects.push_back(&effect);
    if (!grid.contain(wide(effect.message.applied_at)))
      report.add(2, effect, "effect at ST {}, which is not a step boundary",
                 ns(effect.message.applied_at));
  }

  std::vector<Due> due;
  const bool finished = record.footer && record.footer->end == "finished";
  for (auto& [uav, row] : rows) {
    check_effect_order(row, report);
    std::ranges::stable_sort(row.commands, {}, sequence_of<Interaction>);
    const std::vector<Due> matched = match(row, report);
    due.insert(due.end(), matched.begin(), matched.end());
    check_later(row, grid, finished, end_of(record), report);
    check_orphans(row, finished, end_of(record), report);
  }
  check_releases(record, due, report);
  check_missing(due, end_of(record), report);
}

}  // namespace tether::audit
