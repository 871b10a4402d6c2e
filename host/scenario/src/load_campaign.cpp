#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include <tether/base/suggest.h>
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
  if (root.has("seeds") == root.has("trials")) {
    root.fail("trials",
              "or 'seeds' must be given, not both: a number of trials (with 'first_seed'), or an "
              "array of seeds.");
  }
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

CampaignScenario read_scenario(const toml::Table& table) {
  constexpr std::array<std::string_view, 5> kTables = {"I", "II", "III", "IV", "V"};
  CampaignScenario entry;
  entry.scenario = load_scenario(table.existing_file("file"));
  entry.conditions = read_conditions(table, entry.scenario);
  if (table.has("profile")) {
    entry.profile = table.existing_file("profile");
    lay_profile(entry.scenario, load_profile(entry.profile));
  }
  if (table.has("paper_table")) entry.paper_table = kTables[table.choice("paper_table", kTables)];
  return entry;
}

}  // namespace

Campaign load_campaign(const std::filesystem::path& file) {
  Campaign campaign;
  campaign.file = std::filesystem::absolute(file).lexically_normal();
  const toml::Document document = toml::Document::load(campaign.file);
  const toml::Table root = document.root(
      {"name", "description", "trials", "first_seed", "seeds", "images_of_first_seed", "scenario"});
  campaign.name = root.identifier("name");
  campaign.description = root.text_or("description", "");
  campaign.seeds = read_seeds(root);
  campaign.images_of_first_seed = root.boolean_or("images_of_first_seed", false);
  std::set<std::string> names;
  for (const toml::Table& table :
       root.tables("scenario", {"file", "conditions", "profile", "paper_table"})) {
    campaign.scenarios.push_back(read_scenario(table));
    const std::string& name = campaign.scenarios.back().scenario.name;
    if (!names.insert(name).second) {
      table.fail(
          "file",
          fmt::format("is a second scenario with the name \"{}\". Names must be unique.", name));
    }
  }
  return campaign;
}

}  // namespace tether::scenario
