#include "tables/read_vary.h"

#include "quantity.h"

#include <array>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 4> kDistributions = {"value", "uniform", "normal", "one_of"};

/// `value` first: `--set vary.NAME.value=3` holds a quantity that varies otherwise.
Distribution read_distribution(const toml::Table& table, const toml::Range& allowed) {
  if (table.has("value")) return OneOf{{table.number("value", allowed)}};
  std::vector<std::string_view> given;
  for (const std::string_view key : kDistributions)
    if (table.has(key)) given.push_back(key);
  if (given.empty())
    table.fail("needs one of 'uniform', 'normal', 'one_of' and 'value', which say how it varies");
  if (given.size() > 1)
    table.fail(given[1],
               fmt::format("is a second distribution beside '{}'. Remove one of them", given[0]));
  if (table.has("one_of")) return OneOf{table.numbers("one_of", allowed)};
  if (table.has("uniform")) {
    const std::vector<double> limits = table.numbers("uniform", 2, allowed);
    if (limits[0] > limits[1])
      table.fail("uniform", "must be [least, most], but the first is larger");
    return Uniform{limits[0], limits[1]};
  }
  constexpr toml::Range kValue{.min = -1e6, .max = 1e6};
  const std::vector<double> normal = table.numbers("normal", 2, kValue);
  if (normal[1] < 0.0)
    table.fail("normal", "must be [mean, stddev], but the standard deviation is negative");
  if (!allowed.contains(normal[0]))
    table.fail("normal",
               fmt::format("has the mean {:.6g}, but must be {}", normal[0], allowed.text()));
  return Normal{normal[0], normal[1]};
}

}  // namespace

std::vector<Variation> read_vary(const toml::Table& root) {
  std::vector<Variation> variations;
  if (!root.has("vary")) return variations;
  const toml::Table all = root.table("vary");
  std::vector<std::string_view> names;
  for (const Quantity& quantity : quantities()) names.push_back(quantity.name);
  for (const std::string& name : all.keys()) {
    const toml::Table table =
        all.table(name, {"quantity", "of", "uniform", "normal", "one_of", "value"});
    Variation variation;
    variation.name = name;
    const Quantity& quantity = quantities()[table.choice("quantity", names)];
    variation.quantity = quantity.name;
    variation.of = table.text_or("of", "");
    variation.distribution = read_distribution(table, quantity.allowed);
    variation.at = table.where();
    const bool needs_owner = quantity.part == Part::kModel || quantity.part == Part::kPath ||
                             quantity.part == Part::kSensor;
    if (needs_owner && variation.of.empty()) (void)table.text("of");
    variations.push_back(std::move(variation));
  }
  return variations;
}

}  // namespace tether::scenario
