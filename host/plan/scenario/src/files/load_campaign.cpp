#include "files/named_file.h"
#include "files/settings.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/scenario/campaign.h>
#include <tether/toml/table.h>

namespace tether::scenario {
namespace {

constexpr std::int64_t kMostTrials = 100'000;

std::vector<std::uint64_t> consecutive(std::int64_t first, std::int64_t count) {
  std::vector<std::uint64_t> seeds;
  for (std::int64_t i = 0; i < count; ++i) seeds.push_back(static_cast<std::uint64_t>(first + i));
  return seeds;
}

std::vector<std::uint64_t> read_seeds(const toml::Table& root) {
  if (root.has("seeds") && root.has("trials"))
    root.fail("trials", "cannot be used with 'seeds'. Remove one of them.");
  if (!root.has("seeds") && !root.has("trials"))
    root.fail("trials", "is missing. Write trials = 10, or seeds = [1, 2, 3].");
  if (root.has("trials")) {
    const std::int64_t first = root.integer_or("first_seed", 0, 1'000'000'000'000, 1);
    return consecutive(first, root.integer_or("trials", 1, kMostTrials, 1));
  }
  if (root.has("first_seed")) root.fail("first_seed", "can be used with 'trials' only.");
  const std::vector<std::int64_t> seeds = root.integers("seeds", 0);
  if (seeds.empty()) root.fail("seeds", "must not be empty.");
  if (std::set<std::int64_t>(seeds.begin(), seeds.end()).size() < seeds.size()) {
    root.fail("seeds", "contains a seed twice. The same trial twice is not a second sample.");
  }
  return {seeds.begin(), seeds.end()};
}

std::vector<std::string> read_conditions(const toml::Table& table, const Scenario& scenario) {
  std::vector<std::string> all;
  for (const Condition& condition : scenario.conditions) all.push_back(condition.name);
  if (!table.has("conditions")) return all;

  const std::vector<std::string> conditions = table.texts("conditions");
  if (conditions.empty())
    table.fail("conditions", "must not be empty. Omit the key to run all conditions.");
  const std::vector<std::string_view> allowed(all.begin(), all.end());
  std::set<std::string> seen;
  for (const std::string& name : conditions) {
    if (scenario.find_condition(name) == nullptr) {
      table.fail("conditions", fmt::format("names \"{}\", which {} does not have; {}", name,
                                           scenario.file.string(), allowed_hint(name, allowed)));
    }
    if (!seen.insert(name).second) {
      table.fail("conditions", fmt::format("names \"{}\" twice.", name));
    }
  }
  return conditions;
}

// Sweeps.

using Settings = std::vector<Setting>;

// One row for each key of the sweep, with all of its values; tables in it are parts of paths.
void add_rows(const toml::Table& table, const std::string& path,
              const std::filesystem::path& folder, std::vector<Settings>& rows) {
  for (const std::string& key : table.keys()) {
    if (path.empty() && key == "paired") continue;
    if (table.is_table(key)) {
      add_rows(table.table(key), path + key + ".", folder, rows);
      continue;
    }
    if (const std::string name = path + key; name == "name" || name == "condition.name")
      table.fail(key, "tells flights apart, and changes none. Remove it from the sweep.");
    rows.emplace_back();
    std::set<std::string> seen;
    for (const std::string& value : table.scalars_as_texts(key)) {
      if (!seen.insert(value).second)
        table.fail(key, fmt::format("has {} twice. Every point is flown once.", value));
      rows.back().push_back(parse_setting(fmt::format("{}{}={}", path, key, value), folder));
    }
  }
}

std::vector<Settings> paired(const toml::Table& sweep, const std::vector<Settings>& rows) {
  std::vector<Settings> points(rows.front().size());
  for (const Settings& row : rows) {
    if (row.size() != points.size())
      sweep.fail("paired",
                 fmt::format("needs as many values of each key, but '{}' has {} and "
                             "'{}' {}. Make them equal, or remove 'paired' to fly all "
                             "combinations.",
                             rows.front().front().key, points.size(), row.front().key, row.size()));
    for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(row[i]);
  }
  return points;
}

// One point without settings if there is no sweep.
std::vector<Settings> read_sweep(const toml::Table& root, const std::filesystem::path& folder) {
  constexpr std::size_t kMostPoints = 1000;
  if (!root.has("sweep")) return {{}};
  const toml::Table sweep = root.table("sweep");
  std::vector<Settings> rows;
  add_rows(sweep, "", folder, rows);
  if (rows.empty()) root.fail("sweep", "must have a key of the scenario with an array of values.");
  if (sweep.boolean_or("paired", false)) return paired(sweep, rows);
  std::vector<Settings> points = {{}};
  for (const Settings& row : rows) {
    std::vector<Settings> longer;
    for (const Settings& point : points) {
      for (const Setting& setting : row) {
        longer.push_back(point);
        longer.back().push_back(setting);
      }
    }
    points = std::move(longer);
    if (points.size() > kMostPoints)
      root.fail("sweep", fmt::format("has more than {} combinations. Use fewer values, or paired = "
                                     "true to fly the first values together, then the second ones.",
                                     kMostPoints));
  }
  return points;
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [key, value] : settings)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value);
  return text;
}

// A mistake in a value of the sweep is one of the campaign file.
Scenario load_point(const toml::Table& root, const std::filesystem::path& file,
                    const Settings& point) {
  if (point.empty()) return load_scenario(file);
  try {
    return load_scenario(file, point, "");
  } catch (const Error& error) {
    root.fail("sweep", fmt::format("with {}: {}", text_of(point), error.what()));
  }
}

CampaignScenario read_scenario(const toml::Table& root, const toml::Table& table,
                               const Settings& point) {
  constexpr std::array<std::string_view, 5> kTables = {"I", "II", "III", "IV", "V"};
  CampaignScenario entry;
  entry.scenario = load_point(root, named_file(table, "file", ShippedKind::kScenario), point);
  if (!point.empty()) {
    const std::string& name = entry.scenario.name;
    entry.swept_from = name.substr(0, name.size() - name_suffix(point).size());
  }
  entry.conditions = read_conditions(table, entry.scenario);
  if (table.has("profile")) {
    entry.profile = named_file(table, "profile", ShippedKind::kProfile);
    lay_profile(entry.scenario, load_profile(entry.profile));
  }
  if (table.has("paper_table")) entry.paper_table = kTables[table.choice("paper_table", kTables)];
  return entry;
}

}  // namespace

Campaign campaign_of(Scenario scenario, const std::vector<std::string>& conditions,
                     std::size_t trials) {
  Campaign campaign{.file = scenario.file,
                    .name = scenario.name,
                    .description = scenario.description,
                    .seeds = consecutive(1, static_cast<std::int64_t>(trials)),
                    .scenarios = {}};
  CampaignScenario entry{.scenario = std::move(scenario), .conditions = {}, .paper_table = {}};
  for (const std::string& name : conditions) {
    entry.conditions.push_back(pick_condition(entry.scenario, name).name);
    if (std::ranges::count(conditions, name) > 1)
      throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\" is given twice.", name))
          .about(name);
  }
  if (conditions.empty())
    for (const Condition& condition : entry.scenario.conditions)
      entry.conditions.push_back(condition.name);
  campaign.scenarios.push_back(std::move(entry));
  return campaign;
}

Campaign load_campaign(const std::filesystem::path& file) {
  Campaign campaign;
  campaign.file = std::filesystem::absolute(file).lexically_normal();
  const toml::Document document = toml::Document::load(campaign.file);
  const toml::Table root = document.root({"name", "description", "trials", "first_seed", "seeds",
                                          "images_of_first_seed", "scenario", "sweep"});
  campaign.name = root.identifier("name");
  campaign.description = root.text_or("description", "");
  campaign.seeds = read_seeds(root);
  campaign.images_of_first_seed = root.boolean_or("images_of_first_seed", false);
  const std::vector<Settings> points = read_sweep(root, campaign.file.parent_path());
  std::set<std::string> names;
  for (const toml::Table& table :
       root.tables("scenario", {"file", "conditions", "profile", "paper_table"})) {
    for (const Settings& point : points) {
      campaign.scenarios.push_back(read_scenario(root, table, point));
      const std::string& name = campaign.scenarios.back().scenario.name;
      if (!names.insert(name).second) {
        table.fail(
            "file",
            fmt::format("is a second scenario with the name \"{}\". Names must be unique.", name));
      }
    }
  }
  return campaign;
}

}  // namespace tether::scenario
