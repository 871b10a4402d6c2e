#include "tables/read_radio.h"

#include "tables/read_delay.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

using toml::Range;

constexpr std::array<std::string_view, 3> kModels = {"ideal", "log_distance", "distribution"};
constexpr std::array<std::string_view, 2> kAccess = {"csma", "tdma"};
constexpr std::int64_t kMostMessages = 65'536;
constexpr Range kSpan_ms{.min = 0.0, .max = 1e4};
constexpr Range kPositive_ms{.min = 0.0, .max = 1e4, .above_min = true};
constexpr Range kLevel_dbm{.min = -300.0, .max = 100.0};
constexpr Range kLoss_db{.min = 0.0, .max = 300.0};
constexpr Range kRate{.min = 1.0, .max = 1e12};
constexpr Range kExponent{.min = 0.0, .max = 20.0, .above_min = true};

void read_channel(const toml::Table& table, radio::Settings& radio) {
  if (table.has("access"))
    radio.access = static_cast<radio::Access>(table.choice("access", kAccess));
  radio.queue_messages = static_cast<std::size_t>(table.integer_or(
      "queue_messages", 1, kMostMessages, static_cast<std::int64_t>(radio.queue_messages)));
  radio.data_rate_bit_s = table.number_or("data_rate_bit_s", kRate, radio.data_rate_bit_s);
  radio.preamble = table.duration_or("preamble_ms", kSpan_ms, radio.preamble);
  radio.header_bytes = static_cast<std::size_t>(table.integer_or(
      "header_bytes", 0, kMostMessages, static_cast<std::int64_t>(radio.header_bytes)));
  radio.bandwidth_hz = table.number_or("bandwidth_hz", kRate, radio.bandwidth_hz);
  radio.tx_power_dbm = table.number_or("tx_power_dbm", kLevel_dbm, radio.tx_power_dbm);
  radio.noise_figure_db = table.number_or("noise_figure_db", kLoss_db, radio.noise_figure_db);
  radio.reference_loss_db = table.number_or("reference_loss_db", kLoss_db, radio.reference_loss_db);
  radio.exponent = table.number_or("exponent", kExponent, radio.exponent);
  radio.shadowing_db = table.number_or("shadowing_db", kLoss_db, radio.shadowing_db);
  radio.wall_loss_db = table.number_or("wall_loss_db", kLoss_db, radio.wall_loss_db);
  if (radio.access == radio::Access::kTdma) {
    for (const std::string_view key : {"carrier_sense_dbm", "contention_slots"})
      if (table.has(key)) table.fail(key, "has no meaning with access = \"tdma\".");
    radio.slot = table.duration("slot_ms", kPositive_ms);
    return;
  }
  radio.carrier_sense_dbm =
      table.number_or("carrier_sense_dbm", kLevel_dbm, radio.carrier_sense_dbm);
  radio.contention_slots = static_cast<std::uint64_t>(table.integer_or(
      "contention_slots", 1, kMostMessages, static_cast<std::int64_t>(radio.contention_slots)));
  radio.slot = table.duration_or("slot_ms", kPositive_ms, radio.slot);
}

void read_drawn(const toml::Table& table, std::vector<std::filesystem::path>& files,
                radio::Settings& radio) {
  constexpr Range kChance{.min = 0.0, .max = 1.0};
  constexpr Range kEnd{.min = 0.0, .max = 1.0, .above_min = true};
  if (table.has("delay")) radio.drawn_delay = read_delay(table, "delay", files);
  radio.loss_probability = table.number_or("loss_probability", kChance, 0.0);
  radio.data_rate_bit_s = table.number_or("data_rate_bit_s", kRate, 0.0);
  if (!table.has("burst_begin_probability") && !table.has("burst_end_probability")) return;
  radio.burst_begin_probability = table.number("burst_begin_probability", kChance);
  radio.burst_end_probability = table.number("burst_end_probability", kEnd);
}

/// The keys of each model, besides those of all.
const std::vector<std::string_view>& keys_of_model(radio::Model model) {
  static const std::array<std::vector<std::string_view>, kModels.size()> keys = {{
      {},
      {"access", "queue_messages", "data_rate_bit_s", "preamble_ms", "header_bytes", "bandwidth_hz",
       "tx_power_dbm", "noise_figure_db", "reference_loss_db", "exponent", "shadowing_db",
       "wall_loss_db", "carrier_sense_dbm", "contention_slots", "slot_ms"},
      {"delay", "loss_probability", "data_rate_bit_s", "burst_begin_probability",
       "burst_end_probability"},
  }};
  return keys[static_cast<std::size_t>(model)];
}

/// Refuses keys of other models.
toml::Table table_of(const toml::Table& parent, radio::Model model) {
  constexpr std::array<std::string_view, 3> kOfAll = {"model", "delay_ms", "inbox_messages"};
  std::vector<std::string_view> known(kOfAll.begin(), kOfAll.end());
  for (std::size_t i = 0; i < kModels.size(); ++i)
    for (const std::string_view key : keys_of_model(static_cast<radio::Model>(i)))
      if (std::ranges::count(known, key) == 0) known.push_back(key);
  toml::Table table = parent.table("radio", known);
  for (const std::string& key : table.keys())
    if (std::ranges::count(kOfAll, key) + std::ranges::count(keys_of_model(model), key) == 0)
      table.fail(key, fmt::format("has no meaning with model = \"{}\".",
                                  kModels[static_cast<std::size_t>(model)]));
  return table;
}

}  // namespace

radio::Settings read_radio(const toml::Table& parent, std::vector<std::filesystem::path>& files) {
  radio::Settings radio;
  if (!parent.has("radio")) return radio;
  radio.model = static_cast<radio::Model>(parent.table("radio").choice("model", kModels));
  const toml::Table table = table_of(parent, radio.model);
  radio.delay = table.duration_or("delay_ms", kSpan_ms, radio.delay);
  radio.inbox_messages = static_cast<std::size_t>(table.integer_or(
      "inbox_messages", 1, kMostMessages, static_cast<std::int64_t>(radio.inbox_messages)));
  if (radio.model == radio::Model::kLogDistance) read_channel(table, radio);
  if (radio.model == radio::Model::kDistribution) read_drawn(table, files, radio);
  return radio;
}

}  // namespace tether::scenario
