#include "checks.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

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

// A command that should act, and where in the file it did.
struct Due {
  const Logged<Interaction>* command = nullptr;
  const Logged<CommandEffect>* effect = nullptr;  // nullptr: never
  Wide effect_at = 0;
};

std::uint64_t sequence_of(const Logged<CommandEffect>* effect) {
  return effect->message.sequence;
}

// Rule 2: a SUT's commands take effect in the order in which it gave them, each once. Leaves the
// effects sorted by sequence.
void check_effect_order(Row& row, Report& report) {
  for (std::size_t i = 1; i < row.effects.size(); ++i) {
    if (sequence_of(row.effects[i]) <= sequence_of(row.effects[i - 1])) {
      report.add(2, *row.effects[i],
                 "took effect after command " + std::to_string(sequence_of(row.effects[i - 1])) +
                     " of the same SUT");
    }
  }
  std::ranges::stable_sort(row.effects, {}, sequence_of);
}

// Rule 2: an effect at the time that its command was given, as written.
void check_effect(const Logged<Interaction>& command, const Logged<CommandEffect>& effect,
                  Report& report) {
  const Wide applied = wide(effect.message.applied_at);
  if (command.message.effect_at && applied != wide(*command.message.effect_at)) {
    report.add(
        2, effect,
        "took effect at ST " + ns(applied) + ", not at " + ns(wide(*command.message.effect_at)));
  }
}

std::vector<Due> match(Row& row, Report& report) {
  std::vector<Due> due;
  auto effect = row.effects.begin();
  for (const Logged<Interaction>* command : row.commands) {
    effect = std::ranges::lower_bound(effect, row.effects.end(), command->message.sequence, {},
                                      sequence_of);
    Due item{command, nullptr, wide(command->message.effect_at.value_or(SimTime{}))};
    if (effect != row.effects.end() && sequence_of(*effect) == command->message.sequence) {
      item.effect = *effect;
      check_effect(*command, **effect, report);
    }
    if (command->message.effect_at) {
      due.push_back(item);
    }
  }
  return due;
}

// Rule 2: no effect without its command. The one exception is a command whose reply was still held
// when the record ended: of a serial SUT the one that follows its last; of a concurrent one any,
// but only at the last ST, which goes no further while a reply is held.
void check_orphans(const Row& row, bool finished, Wide end, Report& report) {
  for (const Logged<CommandEffect>* effect : row.effects) {
    const bool has_command = std::ranges::binary_search(
        row.commands, effect->message.sequence, {},
        [](const Logged<Interaction>* command) { return command->message.sequence; });
    const bool held_at_end =
        !finished && (row.concurrent ? wide(effect->message.applied_at) >= end
                                     : effect->message.sequence == row.last_sequence + 1);
    if (!has_command && !held_at_end) {
      report.add(2, *effect, "took effect without a command of that number");
    }
  }
}

// Rule 3: at a release every command stamped earlier that is due by then has been applied, and the
// simulator was told before the reply left. One pass in file order; a command that is found missing
// is reported at the first release that should have waited for it.
void check_releases(const record::Record& record, std::vector<Due>& due, Report& report) {
  std::ranges::stable_sort(due, {}, &Due::effect_at);
  std::vector<Due> outstanding;
  auto next = due.begin();
  Wide st = 0;
  for (const Logged<Interaction>& release : record.interactions) {
    st = std::max(st, wide(release.message.st_at_release));
    for (; next != due.end() && next->effect_at <= st; ++next) {
      outstanding.push_back(*next);
    }
    std::erase_if(outstanding, [&](const Due& item) {
      if (item.effect != nullptr && item.effect->order < release.order) {
        return true;
      }
      if (item.command->message.request_at >= release.message.reply_at ||
          item.effect_at > wide(release.message.st_at_release)) {
        return false;
      }
      report.add(3, release,
                 "replied at ST " + ns(wide(release.message.st_at_release)) + " before command " +
                     std::to_string(item.command->message.sequence) + " of \"" +
                     item.command->message.uav + "\", due at " + ns(item.effect_at) +
                     ", was in effect");
      return true;
    });
  }
}

// Rule 2: a command whose time came within the run took effect.
void check_missing(const std::vector<Due>& due, Wide end, Report& report) {
  for (const Due& item : due) {
    if (item.effect == nullptr && item.effect_at < end) {
      report.add(2, *item.command,
                 "command due at ST " + ns(item.effect_at) +
                     " never took effect, although ST "
                     "reached " +
                     ns(end));
    }
  }
}

// ST that the run is known to have reached.
Wide end_of(const record::Record& record) {
  if (record.footer) {
    return wide(record.footer->st_at_end);
  }
  return record.interactions.empty() ? Wide{0} : wide(record.interactions.back().at);
}

}  // namespace

void check_commands(const record::Record& record, const Boundaries& grid, Report& report) {
  std::map<std::string, Row> rows;
  for (const record::SutInfo& sut : record.header.suts) {
    rows[sut.uav].concurrent = sut.concurrent;
  }
  for (const Logged<Interaction>& entry : record.interactions) {
    Row& row = rows[entry.message.uav];
    row.last_sequence = std::max(row.last_sequence, entry.message.sequence);
    if (entry.message.kind == record::kCommand) {
      row.commands.push_back(&entry);
    }
  }
  for (const Logged<CommandEffect>& effect : record.commands) {
    rows[effect.message.uav].effects.push_back(&effect);
    if (!grid.contain(wide(effect.message.applied_at))) {
      report.add(2, effect,
                 "took effect at " + ns(wide(effect.message.applied_at)) + ", no step boundary");
    }
  }

  std::vector<Due> due;
  const bool finished = record.footer && record.footer->end == "finished";
  for (auto& [uav, row] : rows) {
    check_effect_order(row, report);
    std::ranges::stable_sort(row.commands, {}, [](const Logged<Interaction>* command) {
      return command->message.sequence;
    });
    const std::vector<Due> matched = match(row, report);
    due.insert(due.end(), matched.begin(), matched.end());
    check_orphans(row, finished, end_of(record), report);
  }
  check_releases(record, due, report);
  check_missing(due, end_of(record), report);
}

}  // namespace tether::audit
