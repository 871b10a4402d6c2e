#include "checks.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

// Each command is matched with its effect by UAV and sequence (rule 2). Then one pass over the
// replies in the order of the file checks that every command that was due is in effect (rule 3).
namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Interaction;
using record::Logged;

// All commands and all effects of one SUT, by sequence.
struct Row {
  std::vector<const Logged<Interaction>*> commands;
  std::vector<const Logged<CommandEffect>*> effects;
  std::uint64_t last_sequence = 0;  // of any interaction
  bool concurrent = false;
};

// A command with an effect time, and its effect in the file.
struct Due {
  const Logged<Interaction>* command = nullptr;
  const Logged<CommandEffect>* effect = nullptr;  // nullptr: none
  Wide effect_at = 0;
};

template <class Message>
std::uint64_t sequence_of(const Logged<Message>* entry) {
  return entry->message.sequence;
}

// Rule 2: a SUT's commands take effect in the order in which it gave them, each once. Leaves the
// effects sorted by sequence.
void check_effect_order(Row& row, Report& report) {
  for (std::size_t i = 1; i < row.effects.size(); ++i) {
    if (sequence_of(row.effects[i]) <= sequence_of(row.effects[i - 1]))
      report.add(2, *row.effects[i], "effect after that of command {} of the same SUT",
                 sequence_of(row.effects[i - 1]));
  }
  std::ranges::stable_sort(row.effects, {}, sequence_of<CommandEffect>);
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

// Rule 2: no effect without its command. The one exception is a command whose reply was still held
// when the record ended: for a serial SUT the one after its last; for a concurrent SUT any, but
// only at the last ST, which does not advance while a reply is held.
void check_orphans(const Row& row, bool finished, Wide end, Report& report) {
  for (const Logged<CommandEffect>* effect : row.effects) {
    const bool has_command =
        std::ranges::binary_search(row.commands, sequence_of(effect), {}, sequence_of<Interaction>);
    const bool held_at_end =
        !finished && (row.concurrent ? wide(effect->message.applied_at) >= end
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

void check_velocities(const record::Record& record, Report& report) {
  std::map<std::pair<std::string, std::uint64_t>, record::VelocityCommand> asked;
  for (const Logged<Interaction>& entry : record.interactions)
    if (entry.message.command)
      asked[{entry.message.uav, entry.message.sequence}] = *entry.message.command;
  if (asked.empty() && record.header.time_limit <= Duration(0)) return;  // Tether 0.1.0
  for (const Logged<Interaction>& entry : record.interactions)
    if (entry.message.command.has_value() != (entry.message.kind == record::kCommand))
      report.add(0, entry, "a {} {} a velocity", entry.message.kind,
                 entry.message.command ? "with" : "without");
  for (const Logged<CommandEffect>& effect : record.commands) {
    const CommandEffect& m = effect.message;
    const auto found = asked.find({m.uav, m.sequence});
    if (found == asked.end() || found->second == m.command()) continue;
    const auto& [vx, vy, vz, yaw_rate] = found->second;
    report.add(
        2, effect,
        "({}, {}, {}) m/s and {} rad/s take effect instead of the command's ({}, {}, {}) m/s "
        "and {} rad/s",
        m.vx_H_m_s, m.vy_H_m_s, m.vz_H_m_s, m.yaw_rate_rad_s, vx, vy, vz, yaw_rate);
  }
}

void check_commands(const record::Record& record, const Boundaries& grid, Report& report) {
  std::map<std::string, Row> rows;
  for (const record::SutInfo& sut : record.header.suts) rows[sut.uav].concurrent = sut.concurrent;
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
    check_orphans(row, finished, end_of(record), report);
  }
  check_releases(record, due, report);
  check_missing(due, end_of(record), report);
}

}  // namespace tether::audit
