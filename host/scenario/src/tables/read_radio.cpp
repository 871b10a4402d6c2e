#include "tables/read_radio.h"

#include <array>
#include <string_view>

namespace tether::scenario {
namespace {

using toml::Range;

constexpr std::array<std::string_view, 2> kModels = {"ideal", "log_distance"};
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

}  // namespace

radio::Settings read_radio(const toml::Table& parent) {
  radio::Settings radio;
  if (!parent.has("radio")) return radio;
  const toml::Table table = parent.table(
      "radio", {"model", "delay_ms", "inbox_messages", "access", "queue_messages",
                "data_rate_bit_s", "preamble_ms", "header_bytes", "bandwidth_hz", "tx_power_dbm",
                "noise_figure_db", "reference_loss_db", "exponent", "shadowing_db", "wall_loss_db",
                "carrier_sense_dbm", "contention_slots", "slot_ms"});
  radio.model = static_cast<radio::Model>(table.choice("model", kModels));
  radio.delay = table.duration_or("delay_ms", kSpan_ms, radio.delay);
  radio.inbox_messages = static_cast<std::size_t>(table.integer_or(
      "inbox_messages", 1, kMostMessages, static_cast<std::int64_t>(radio.inbox_messages)));
  if (radio.model == radio::Model::kLogDistance) {
    read_channel(table, radio);
    return radio;
  }
  for (const std::string& key : table.keys())
    if (key != "model" && key != "delay_ms" && key != "inbox_messages")
      table.fail(key, "has no meaning with model = \"ideal\".");
  return radio;
}

}  // namespace tether::scenario
