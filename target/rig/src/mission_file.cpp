#include <algorithm>
#include <vector>

#include <tether/mission/mission.h>
#include <tether/rig/mission.h>
#include <tether/toml/table.h>

namespace tether::rig {
namespace {

using toml::Table;
using Names = std::vector<std::string_view>;

Names names_of(const std::vector<Field>& fields, Names others) {
  for (const Field& field : fields) others.push_back(field.name);
  return others;
}

// What a field's value is, `key` of `table`.

void read(const Table& table, std::string_view key, const TextField& field) {
  *field.value = table.text(key);
}
void read(const Table& table, std::string_view key, const NumberField& field) {
  field.set(table.number(key, {.min = field.least, .max = field.most}));
}
void read(const Table& table, std::string_view key, const IntegerField& field) {
  *field.value = static_cast<int>(table.integer(key, field.least, field.most));
  if (field.is_odd && *field.value % 2 == 0) table.fail(key, "must be odd");
}
void read(const Table& table, std::string_view key, const BooleanField& field) {
  *field.value = table.boolean(key);
}
void read(const Table& table, std::string_view key, const ChoiceField& field) {
  field.set(table.choice(key, field.words));
}

bool is_required(const Field& field) {
  const auto* text = std::get_if<TextField>(&field.value);
  return text != nullptr && text->is_required;
}

/// `sources`: the task's own table, then what the tasks share; the first that has a key counts.
void read(const std::vector<Table>& sources, const Field& field) {
  const auto has = [&field](const Table& table) { return table.has(field.name); };
  const auto found = std::find_if(sources.begin(), sources.end(), has);
  if (found == sources.end() && !is_required(field)) return;
  const Table& table = found == sources.end() ? sources.front() : *found;
  std::visit([&](const auto& value) { read(table, field.name, value); }, field.value);
}

/// What follows the task. Only with `on_miss` is a late task a missed one: without it, deadlines
/// are for the host alone.
void take_order(const mission::Task& order, TaskSpec& spec) {
  using Kind = mission::OnMiss::Kind;
  spec.name = order.name;
  spec.retry = order.retry;
  spec.required = order.on_miss.kind != Kind::kContinue;
  if (!order.acts_on_lateness) return;
  if (order.on_miss.kind == Kind::kGoTo) spec.otherwise = order.on_miss.task;
  spec.within = order.within;
  spec.before = order.before;
}

TaskSpec read_task(const Table& task, const mission::Task& order,
                   const std::vector<Table>& common) {
  Names tasks;
  for (const TaskKind& kind : task_kinds()) tasks.push_back(kind.name);
  TaskSpec spec;
  spec.options = task_kinds()[task.choice("task", tasks)].defaults;
  take_order(order, spec);
  const std::vector<Field> fields = fields_of(spec);
  task.require_keys_in(
      names_of(fields, {mission::task_keys().begin(), mission::task_keys().end()}));
  std::vector<Table> sources = {task};
  sources.insert(sources.end(), common.begin(), common.end());
  for (const Field& field : fields) read(sources, field);
  return spec;
}

/// What the tasks share: the keys of `[vision]`, and then those at the top.
std::vector<Table> read_common(const Table& file) {
  std::vector<Table> common;
  if (file.has("vision")) {
    TaskSpec spec;
    common.push_back(file.table("vision", names_of(vision_fields(spec), {})));
  }
  Names any = {"task", "vision", "clause", "fence"};
  for (const TaskKind& kind : task_kinds()) {
    TaskSpec spec;
    spec.options = kind.defaults;
    any = names_of(fields_of(spec), std::move(any));
  }
  std::sort(any.begin(), any.end());
  any.erase(std::unique(any.begin(), any.end()), any.end());
  file.require_keys_in(any);
  common.push_back(file);
  return common;
}

Mission read_mission(const toml::Document& document) {
  const Table file = document.root();
  const mission::Mission order = mission::read_mission(file);
  const std::vector<Table> tasks = file.tables("task");
  const std::vector<Table> common = read_common(file);
  Mission mission;
  mission.is_sequence = true;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    mission.tasks.push_back(read_task(tasks[i], order.tasks[i], common));
  return mission;
}

}  // namespace

Result<Mission> parse_mission(const std::string& text, const std::string& path) {
  return toml::result_of([&] { return read_mission(toml::Document::parse(text, path)); });
}

Result<Mission> load_mission(const std::string& path) {
  return toml::result_of([&] { return read_mission(toml::Document::load(path)); });
}

}  // namespace tether::rig
