#include "contradictions.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <tether/base/text.h>
#include <tether/mission/mission.h>
#include <tether/toml/table.h>

// Reads the tasks first, because clauses refer to them by name; then the clauses, each checked by
// itself; then what clauses demand together.
namespace tether::mission {
namespace {

using toml::Table;
using Kind = Clause::Kind;

constexpr toml::Range kTime_s{.min = 0.0, .max = 1e6, .above_min = true};
constexpr std::array<std::string_view, 2> kNoTasks = {"continue", "abort"};
constexpr std::array<std::string_view, 10> kClauseKeys = {
    "name",       "during", "after",    "always",   "never",
    "eventually", "for_s",  "within_s", "before_s", "ends_flight"};

std::optional<Duration> time_if(const Table& table, std::string_view key) {
  if (!table.has(key)) return std::nullopt;
  return table.duration(key, kTime_s);
}

std::string seconds_text(Duration time) {
  return toml::number_text(to_seconds(time)) + " s";
}

std::size_t task_of(const Table& table, std::string_view key, const std::string& name,
                    const std::vector<Task>& tasks) {
  std::vector<std::string_view> names(tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].name == name) return i;
    names[i] = tasks[i].name;
  }
  table.fail(key, "names the task \"" + name + "\", which the mission does not have; " +
                      allowed_hint(name, names));
}

// Tasks.

/// Its kind; if an earlier task has this name, with its number: "face_anchor_3".
std::string default_name(const std::string& kind, const std::vector<Task>& earlier) {
  const auto is_taken = [&](const Task& task) { return task.name == kind; };
  return std::any_of(earlier.begin(), earlier.end(), is_taken)
             ? kind + "_" + std::to_string(earlier.size() + 1)
             : kind;
}

Task read_task(const Table& table, const std::vector<Task>& earlier) {
  Task task;
  task.kind = table.text("task");
  task.name = table.has("name") ? table.identifier("name") : default_name(task.kind, earlier);
  const auto is_same = [&](const Task& other) { return other.name == task.name; };
  if (std::any_of(earlier.begin(), earlier.end(), is_same))
    table.fail(
        table.has("name") ? "name" : "task",
        "is \"" + task.name + "\", which is also the name of another task. Names must be unique.");
  if (std::count(kNoTasks.begin(), kNoTasks.end(), task.name) > 0)
    table.fail("name", "must not be \"continue\" or \"abort\", which have a meaning in 'on_miss'");
  task.retry = static_cast<int>(table.integer_or("retry", 0, 100, 0));
  task.within = time_if(table, "within_s");
  task.before = time_if(table, "before_s");
  if (task.within && task.before && *task.within > *task.before)
    table.fail("within_s",
               "is later than 'before_s', which the mission's start precedes. It can "
               "have no effect.");
  return task;
}

/// `on_miss`, or `required`, which says the same of missions without names.
OnMiss read_on_miss(const Table& table, std::size_t index, const std::vector<Task>& tasks) {
  const bool is_required = table.boolean_or("required", true);
  if (!table.has("on_miss"))
    return {is_required ? OnMiss::Kind::kAbort : OnMiss::Kind::kContinue, 0};
  if (table.has("required")) table.fail("required", "contradicts 'on_miss'. Remove one of them.");
  const std::string word = table.text("on_miss");
  if (word == kNoTasks[0]) return {OnMiss::Kind::kContinue, 0};
  if (word == kNoTasks[1]) return {OnMiss::Kind::kAbort, 0};
  const std::size_t to = task_of(table, "on_miss", word, tasks);
  if (to <= index)
    table.fail("on_miss", "is \"" + word +
                              "\", which makes a cycle. Name a later task, or use "
                              "'retry'.");
  return {OnMiss::Kind::kGoTo, to};
}

std::vector<Task> read_tasks(const Table& file) {
  const std::vector<Table> tables = file.tables("task");
  std::vector<Task> tasks;
  for (const Table& table : tables) tasks.push_back(read_task(table, tasks));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    tasks[i].on_miss = read_on_miss(tables[i], i, tasks);
    tasks[i].acts_on_lateness = tables[i].has("on_miss");
  }
  return tasks;
}

// Clauses.

/// What conditions can name.
struct Names {
  std::string anchor;  ///< if they name none
  std::map<std::string, std::vector<Corner>> fences;
};

std::vector<Corner> read_corners(const Table& table) {
  constexpr toml::Range kFar_m{.min = -1e5, .max = 1e5};
  const std::vector<double> x_m = table.numbers("x_m", kFar_m), y_m = table.numbers("y_m", kFar_m);
  if (x_m.size() != y_m.size() || x_m.size() < 3)
    table.fail("x_m", "and 'y_m' need a number for each corner, and three corners or more");
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < x_m.size(); ++i) corners.push_back({x_m[i], y_m[i]});
  return corners;
}

Names read_names(const Table& file) {
  constexpr std::array<std::string_view, 3> kFenceKeys = {"name", "x_m", "y_m"};
  Names names{file.text_or("anchor", ""), {}};
  if (!file.has("fence")) return names;
  for (const Table& table : file.tables("fence", kFenceKeys))
    if (!names.fences.emplace(table.identifier("name"), read_corners(table)).second)
      table.fail("name", "is that of another fence");
  return names;
}

Condition read_condition(const Table& table, std::string_view key, const Names& names) {
  Result<Condition> condition = parse_condition(table.text(key));
  if (!condition) table.fail(key, condition.failure().message);
  if (condition->quantity->subject == Subject::kAnchor && condition->of.empty()) {
    if (names.anchor.empty())
      table.fail(key, "does not name the anchor. Add 'of NAME', or 'anchor' at the top.");
    condition->of = names.anchor;
  }
  if (condition->quantity->subject == Subject::kFence) {
    const auto fence = names.fences.find(condition->of);
    if (fence == names.fences.end())
      table.fail(key,
                 "does not name a fence of the mission. Add 'of NAME', and a [[fence]] with "
                 "this name.");
    condition->fence = fence->second;
  }
  return std::move(condition).value();
}

void read_kind(const Table& table, const Names& names, Clause& clause) {
  constexpr std::array<std::pair<std::string_view, Kind>, 3> kKinds = {
      {{"always", Kind::kAlways}, {"never", Kind::kNever}, {"eventually", Kind::kEventually}}};
  for (const auto& [key, kind] : kKinds) {
    if (!table.has(key)) continue;
    if (clause.condition)
      table.fail(key, "is a second condition. Write a [[clause]] for each condition.");
    clause.kind = kind;
    clause.condition = read_condition(table, key, names);
    if (clause.condition->share < 1.0 && kind != Kind::kAlways)
      table.fail(key, "has a share, which needs 'always'");
    if (clause.condition->quantity->is_event && kind == Kind::kEventually)
      table.fail(key, "is about commands or reads, which needs 'always' or 'never'");
  }
}

void read_times(const Table& table, Clause& clause) {
  clause.within = time_if(table, "within_s");
  clause.before = time_if(table, "before_s");
  if (clause.within && clause.before)
    table.fail("before_s", "is a second deadline. Write a [[clause]] for each deadline.");
  const bool has_deadline = clause.within || clause.before;
  const bool is_throughout = clause.kind == Kind::kAlways || clause.kind == Kind::kNever;
  if (clause.kind == Kind::kDeadline && !has_deadline)
    table.fail("needs one of 'always', 'never', 'eventually', 'within_s' and 'before_s'");
  if (is_throughout && has_deadline)
    table.fail(clause.within ? "within_s" : "before_s",
               "is a deadline, which needs 'eventually' or no condition");
  if (!table.has("for_s")) return;
  clause.hold = table.duration("for_s", kTime_s);
  if (clause.kind != Kind::kEventually) table.fail("for_s", "needs 'eventually'");
  const Duration deadline = clause.within   ? *clause.within
                            : clause.before ? *clause.before
                                            : Duration::max();
  if (clause.hold > deadline)
    table.fail("for_s", "is longer than the deadline of " + seconds_text(deadline) + " allows");
}

void read_span(const Table& table, const std::vector<Task>& tasks, Clause& clause) {
  if (table.has("after")) clause.after = task_of(table, "after", table.text("after"), tasks);
  if (!table.has("during")) return;
  if (clause.after) table.fail("during", "cannot be combined with 'after'");
  for (const std::string& name : table.texts("during")) {
    const std::size_t task = task_of(table, "during", name, tasks);
    if (!clause.during) clause.during = {task, task};
    if (task < clause.during->second)
      table.fail("during", "must name the tasks in the order of the mission");
    clause.during->second = task;
  }
  if (!clause.during) table.fail("during", "is empty. Name a task, or omit 'during'.");
}

void read_ends_flight(const Table& table, Clause& clause) {
  clause.ends_flight = table.boolean_or("ends_flight", false);
  if (!clause.ends_flight) return;
  const bool is_throughout = clause.kind == Kind::kAlways || clause.kind == Kind::kNever;
  if (!is_throughout || clause.condition->share < 1.0)
    table.fail("ends_flight", "needs 'always' or 'never' without a share");
  if (clause.during || clause.after)
    table.fail("ends_flight", "is for the whole mission. Remove 'during' and 'after'.");
  if (!clause.condition->quantity->is_of_truth())
    table.fail("ends_flight",
               "needs a quantity that the ground truth has, such as 'altitude', not '" +
                   std::string(clause.condition->quantity->name) + "'");
}

std::string span_text(const Clause& clause, const std::vector<Task>& tasks) {
  if (clause.after) return "after " + tasks[*clause.after].name;
  if (!clause.during) return "mission";
  const auto [first, last] = *clause.during;
  return first == last ? tasks[first].name : tasks[first].name + " to " + tasks[last].name;
}

std::string text_of(const Clause& clause, const std::vector<Task>& tasks) {
  constexpr std::array kWords = {"", "always ", "never ", "eventually "};
  std::string text = span_text(clause, tasks);
  if (clause.condition)
    text += ": " + std::string(kWords[static_cast<std::size_t>(clause.kind)]) +
            clause.condition->text();
  if (clause.hold > Duration(0)) text += " for " + seconds_text(clause.hold);
  if (clause.within) text += " within " + seconds_text(*clause.within);
  if (clause.before) text += " before " + seconds_text(*clause.before);
  return text;
}

/// Whether a key is meant as a deadline: "within", "before_ms", "deadline_s".
bool is_nearly_deadline(std::string_view key, std::string_view known) {
  const std::string_view stem = key.substr(0, key.find('_'));
  if (known == "within_s") return key != known && (stem == "within" || stem == "deadline");
  return known == "before_s" && key != known && stem == "before";
}

/// Other keys are the program's own, but for what is nearly one of these.
void refuse_misspelt(const Table& table, std::span<const std::string_view> keys) {
  for (const std::string& key : table.keys())
    for (const std::string_view known : keys)
      if (is_misspelt(key, known) || is_nearly_deadline(key, known))
        table.fail(key, "is not known; did you mean '" + std::string(known) +
                            "'? If it is a key of your program's own, give it another name.");
}

Clause read_clause(const Table& table, const Names& names, const std::vector<Task>& tasks) {
  table.require_keys_in(kClauseKeys);
  Clause clause;
  clause.where = table.where();
  read_kind(table, names, clause);
  read_times(table, clause);
  read_span(table, tasks, clause);
  read_ends_flight(table, clause);
  clause.name = table.has("name") ? table.text("name") : text_of(clause, tasks);
  return clause;
}

/// Those of the tasks' own deadlines.
void add_deadlines(const Table& file, Mission& mission) {
  const std::vector<Table> tables = file.tables("task");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const Task& task = mission.tasks[i];
    for (const bool is_within : {true, false}) {
      Clause clause;
      clause.during = {i, i};
      (is_within ? clause.within : clause.before) = is_within ? task.within : task.before;
      if (!clause.within && !clause.before) continue;
      clause.where = tables[i].where(is_within ? "within_s" : "before_s");
      clause.name = text_of(clause, mission.tasks);
      mission.clauses.push_back(std::move(clause));
    }
  }
}

void require_unique_names(const Mission& mission) {
  std::set<std::string> names;
  for (const Clause& clause : mission.clauses)
    if (!names.insert(clause.name).second)
      throw Error(ErrorCode::kBadFile, clause.where,
                  "there is another clause \"" + clause.name + "\". Give this one another 'name'.")
          .about(clause.name);
}

}  // namespace

std::span<const std::string_view> task_keys() {
  static constexpr std::array<std::string_view, 7> kKeys = {
      "task", "name", "required", "on_miss", "retry", "within_s", "before_s"};
  return kKeys;
}

Mission read_mission(const Table& file) {
  Mission mission;
  mission.file = file.where().file;
  constexpr std::array<std::string_view, 4> kTopKeys = {"task", "clause", "fence", "anchor"};
  refuse_misspelt(file, kTopKeys);
  if (!file.has("task"))
    throw Error(ErrorCode::kBadFile, {mission.file, 1},
                "the mission has no task; add at least one [[task]]");
  for (const Table& table : file.tables("task")) refuse_misspelt(table, task_keys());
  mission.tasks = read_tasks(file);
  add_deadlines(file, mission);
  const Names names = read_names(file);
  if (file.has("clause"))
    for (const Table& table : file.tables("clause"))
      mission.clauses.push_back(read_clause(table, names, mission.tasks));
  require_unique_names(mission);
  require_no_contradictions(mission);
  return mission;
}

Mission load_mission(const std::filesystem::path& file) {
  return read_mission(toml::Document::load(file).root());
}

void require_possible(const Mission& mission, const Surroundings& surroundings) {
  for (const Clause& clause : mission.clauses) {
    const auto fail = [&](const std::string& why) {
      throw Error(ErrorCode::kBadFile, clause.where, "the clause \"" + clause.name + "\" " + why)
          .about(clause.name);
    };
    for (const auto& time : {clause.within, clause.before, std::optional(clause.hold)})
      if (time && *time > surroundings.time_limit)
        fail("has a time of " + seconds_text(*time) + ", beyond the scenario's time_limit_s of " +
             seconds_text(surroundings.time_limit) + ". Raise that, or shorten this.");
    if (clause.condition && clause.condition->quantity->needs_battery() &&
        !surroundings.has_battery)
      fail("is about " + std::string(clause.condition->quantity->name) +
           ", which needs a model of energy. Add 'energy' to the scenario's [[uav]].");
    if (!clause.condition || clause.condition->quantity->subject != Subject::kAnchor) continue;
    const std::vector<std::string>& anchors = surroundings.anchors;
    const std::vector<std::string_view> names(anchors.begin(), anchors.end());
    if (std::count(names.begin(), names.end(), clause.condition->of) == 0)
      fail("names the anchor \"" + clause.condition->of + "\", which the scenario does not have; " +
           allowed_hint(clause.condition->of, names));
  }
}

}  // namespace tether::mission
