#include "tables/read_vary.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

constexpr toml::Range kValue{.min = -1e6, .max = 1e6};
constexpr std::array<std::string_view, 4> kDistributions = {"value", "uniform", "normal", "one_of"};

/// `value` first: `--set vary.NAME.value=3` holds a quantity that varies otherwise.
Distribution read_distribution(const toml::Table& table) {
  if (table.has("value")) return OneOf{{table.number("value", kValue)}};
  int given = 0;
  for (const std::string_view key : kDistributions) given += table.has(key) ? 1 : 0;
  if (given != 1)
    table.fail("needs one of 'uniform', 'normal', 'one_of' and 'value', which say how it varies");
  if (table.has("one_of")) return OneOf{table.numbers("one_of", kValue)};
  const std::string_view key = table.has("uniform") ? "uniform" : "normal";
  const std::vector<double> two = table.numbers(key, 2, kValue);
  if (key == "uniform" && two[0] > two[1])
    table.fail(key, "must be [least, most], but the first is larger");
  if (key == "normal" && two[1] < 0.0)
    table.fail(key, "must be [mean, stddev], but the standard deviation is negative");
  return key == "uniform" ? Distribution(Uniform{two[0], two[1]})
                          : Distribution(Normal{two[0], two[1]});
}

}  // namespace

std::vector<Variation> read_vary(const toml::Table& root) {
  std::vector<Variation> variations;
  if (!root.has("vary")) return variations;
  const toml::Table all = root.table("vary");
  const std::vector<std::string_view> names = quantities();
  for (const std::string& name : all.keys()) {
    const toml::Table table =
        all.table(name, {"quantity", "of", "uniform", "normal", "one_of", "value"});
    Variation variation;
    variation.name = name;
    variation.quantity = names[table.choice("quantity", names)];
    variation.of = table.text_or("of", "");
    variation.distribution = read_distribution(table);
    variation.at = table.where();
    const bool needs_owner = std::ranges::any_of(
        std::array{"model_", "path_", "sensor_"},
        [&](const char* owner) { return variation.quantity.starts_with(owner); });
    if (needs_owner && variation.of.empty()) (void)table.text("of");
    variations.push_back(std::move(variation));
  }
  return variations;
}

}  // namespace tether::scenario
