#include "tables/read_radio.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::scenario {
namespace {

radio::Settings read(const std::string& text) {
  const toml::Document document = toml::Document::parse(text, "s.toml");
  std::vector<std::filesystem::path> files;
  return read_radio(document.root(), files);
}

TEST(ReadRadio, IsIdealByDefault) {
  EXPECT_EQ(read("").model, radio::Model::kIdeal);
  EXPECT_EQ(read("").delay, Duration(0));
  EXPECT_EQ(read("[radio]\nmodel = \"ideal\"\ndelay_ms = 2.5").delay, Duration(2'500'000));
}

TEST(ReadRadio, ReadsAChannel) {
  const radio::Settings radio = read(R"([radio]
model = "log_distance"
access = "tdma"
slot_ms = 5
data_rate_bit_s = 250e3
exponent = 3
wall_loss_db = 12
queue_messages = 3
inbox_messages = 7
)");
  EXPECT_EQ(radio.model, radio::Model::kLogDistance);
  EXPECT_EQ(radio.access, radio::Access::kTdma);
  EXPECT_EQ(radio.slot, Duration(5'000'000));
  EXPECT_EQ(radio.data_rate_bit_s, 250e3);
  EXPECT_EQ(radio.exponent, 3.0);
  EXPECT_EQ(radio.wall_loss_db, 12.0);
  EXPECT_EQ(radio.queue_messages, 3U);
  EXPECT_EQ(radio.inbox_messages, 7U);
}

TEST(ReadRadio, ReadsADistribution) {
  const radio::Settings radio = read(R"([radio]
model = "distribution"
delay_ms = 2
delay = { kind = "normal", mean_ms = 5, stddev_ms = 1 }
loss_probability = 0.1
burst_begin_probability = 0.02
burst_end_probability = 0.25
data_rate_bit_s = 1e6
)");
  EXPECT_EQ(radio.model, radio::Model::kDistribution);
  EXPECT_EQ(radio.delay, Duration(2'000'000));
  EXPECT_EQ(std::get<uav::NormalDelay>(radio.drawn_delay).mean, Duration(5'000'000));
  EXPECT_EQ(radio.loss_probability, 0.1);
  EXPECT_EQ(radio.burst_begin_probability, 0.02);
  EXPECT_EQ(radio.burst_end_probability, 0.25);
  EXPECT_EQ(radio.data_rate_bit_s, 1e6);
  EXPECT_EQ(read("[radio]\nmodel = \"distribution\"").data_rate_bit_s, 0.0) << "bytes take no time";
}

TEST(ReadRadio, RefusesKeysWithoutMeaningAndValuesOutOfRange) {
  const std::string channel = "model = \"log_distance\"\n";
  const std::string drawn = "model = \"distribution\"\n";
  for (const auto& [text, key] : {
           std::pair{std::string("delay_ms = 1"), "model"},
           {"model = \"wifi\"", "model"},
           {"model = \"ideal\"\nexponent = 2", "exponent"},
           {channel + "exponent = 0", "exponent"},
           {channel + "data_rate_bit_s = 0", "data_rate_bit_s"},
           {channel + "queue_messages = 0", "queue_messages"},
           {channel + "access = \"tdma\"", "slot_ms"},
           {channel + "access = \"tdma\"\nslot_ms = 1\ncontention_slots = 4", "contention_slots"},
           {channel + "slot_ms = 0", "slot_ms"},
           {channel + "rate = 1", "rate"},
           {channel + "loss_probability = 0.1", "loss_probability"},
           {drawn + "exponent = 2", "exponent"},
           {drawn + "loss_probability = 1.1", "loss_probability"},
           {drawn + "burst_begin_probability = 0.1", "burst_end_probability"},
           {drawn + "burst_begin_probability = 0.1\nburst_end_probability = 0",
            "burst_end_probability"},
           {drawn + "delay = 5", "delay"},
       }) {
    const std::string table = "[radio]\n" + text;
    const Error error = bad_file_error([&] { read(table); });
    EXPECT_EQ(error.subject(), key) << text;
  }
}

}  // namespace
}  // namespace tether::scenario
