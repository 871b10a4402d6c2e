#include "json/json_metadata.h"
#include "mcap/mcap_writer.h"
#include "sample_messages.h"

#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>
#include <tether/record_testing/canonical.h>

namespace tether::record {
namespace {

// `canonical` has every member of every message, `to_metadata` those of header and footer.
TEST(Recorder, WholeRecordIsTheSameEachTimeAndReadBack) {
  Record written;
  written.header = header();
  written.interactions = {{st_ms(37), 0, sensor_interaction()},
                          {st_ms(40), 2, command_interaction()},
                          {st_ms(50), 7, sleep_interaction()},
                          {st_ms(50), 9, vain_interaction()}};
  written.annotations = {{st_ms(38), 1, annotation()}};
  written.ground_truth = {{st_ms(40), 3, ground_truth()}};
  written.commands = {{st_ms(41), 4, command_effect()}};
  written.images = {{st_ms(41), 5, image()}};
  written.contacts = {{st_ms(50), 6, contact()}};
  written.stops = {{st_ms(50), 8, stop()}};
  written.footer = footer();
  written.footer->topics = {{"/interactions", 4}, {"/task/a", 1},     {"/ground_truth/a", 1},
                            {"/tf", 1},           {"/commands/a", 1}, {"/images/a/camera", 1},
                            {"/contacts/a", 1},   {"/stops/a", 1}};
  const TemporaryFile file;
  write_whole_record(file.path());
  const TemporaryFile again;
  write_whole_record(again.path());
  EXPECT_EQ(again.bytes(), file.bytes());
  for (const bool images : {true, false}) {
    const Record read = read_record(file.path(), {.images = images});
    if (!images) written.images.clear();
    EXPECT_EQ(read.damage, "");
    EXPECT_EQ(canonical(read, {.arrivals = true}), canonical(written, {.arrivals = true}));
    EXPECT_EQ(to_metadata(read.header), to_metadata(written.header));
    EXPECT_EQ(to_metadata(read.footer.value()), to_metadata(*written.footer));
    EXPECT_EQ(read.ground_truth[0].order, 3U);
    EXPECT_EQ(read.stops[0].order, 8U);
    EXPECT_EQ(read.interactions[3].order, 9U) << "images count";
    EXPECT_EQ(read.unloaded.size(), images ? 1U : 2U);
    EXPECT_EQ(read.unloaded.at("/tf"), 1U);
  }
}

// With what these follow from, and what else the audit compares.
TEST(Recorder, ModelsAndCommandsAreReadBack) {
  Header written = header();
  written.time_limit = Duration(5);
  written.only_uavs_move = written.moves_by_forces = true;
  written.suts[0].extent_m = 0.25;
  written.suts[0].max_angular_acceleration_rad_s2 = 500.0;
  written.suts[0].load = {0.7, 9.8, {{0.2, SimTime(Duration(5)), SimTime(Duration(7))}, {0.1}}};
  written.suts[0].energy = {7200.0, 0.02, 0.9, {{0.0, 10.0}, {1.0, 12.6}}, 80.0, 2.0, 3.0, 4.0};
  written.radio = {.model = "log_distance",
                   .least_delay = Duration(7),
                   .data_rate_bit_s = 6e6,
                   .inbox_messages = 256,
                   .access = "tdma",
                   .queue_messages = 64};
  written.radio.header_bytes = 36;
  written.radio.tx_power_dbm = -15.5;
  Interaction command = command_interaction();
  command.command = {0.5, -0.25, 1.0 / 3.0, -0.0};
  const TemporaryFile file;
  {
    const auto recorder = make_mcap_recorder(file.path());
    recorder->write(written);
    recorder->write(st_ms(40), command);
  }
  const Record read = read_record(file.path());
  EXPECT_EQ(to_metadata(read.header), to_metadata(written));
  EXPECT_EQ(read.header.radio, written.radio);
  EXPECT_EQ(read.header.suts[0].energy, written.suts[0].energy);
  EXPECT_EQ(read.header.suts[0].load, written.suts[0].load);
  EXPECT_EQ(read.interactions[0].message.command, command.command);
}

TEST(Recorder, RawImagesAreReadBackIfAskedFor) {
  const TemporaryFile file;
  const RawImage depths{"uav1", "rgbd", st_ms(1), 3, 2, 1, std::vector{1.5F, 2.5F}};
  RawImage labels = depths;
  labels.pixels = std::vector<std::uint16_t>{7, 0};
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  for (const RawImage& image : {depths, labels, depths}) recorder->write(st_ms(2), image);
  recorder->write(footer());
  for (const bool images : {true, false}) {
    const Record read = read_record(file.path(), {.images = images});
    EXPECT_EQ(read.damage, "");
    EXPECT_TRUE(read.miscounts.empty());
    ASSERT_EQ(read.raw_images.size(), images ? 3U : 0U);
    if (!images) continue;
    EXPECT_EQ(read.raw_images[0].message.pixels, depths.pixels);
    EXPECT_EQ(read.raw_images[1].message.pixels, labels.pixels);
  }
}

// After a kill, at most the last second is missing.
TEST(Recorder, WritesAChunkEverySecond) {
  const TemporaryFile file;
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  EXPECT_EQ(read_record(file.path()).header.scenario, "face_anchor");
  for (std::int64_t ms = 0; ms <= 5000; ms += 10) {
    recorder->write(st_ms(ms), ground_truth(ms));
  }
  const Record record = read_record(file.path());
  ASSERT_EQ(record.ground_truth.size(), 500U);
  EXPECT_EQ(record.ground_truth.back().at, st_ms(4990));
}

// After a kill, everything up to the last flush is there.
TEST(Recorder, FlushWritesToTheFile) {
  const TemporaryFile file;
  const TemporaryFile killed;
  const auto recorder = make_mcap_recorder(file.path());
  write_messages(*recorder);
  recorder->flush();
  recorder->flush();
  killed.set_bytes(file.bytes());
  recorder->write(st_ms(51), command_interaction(4));

  const Record record = read_record(killed.path(), {.images = true});
  EXPECT_EQ(record.interactions.size(), 4U);
  EXPECT_EQ(record.interactions.back().at, st_ms(50));
  EXPECT_EQ(record.images.size(), 1U);
  EXPECT_FALSE(record.footer.has_value());
  EXPECT_EQ(killed.bytes().size(), file.bytes().size());

  recorder->write(footer());
  recorder->flush();
  const TemporaryFile unflushed;
  const auto other = make_mcap_recorder(unflushed.path());
  write_messages(*other);
  other->write(st_ms(51), command_interaction(4));
  other->write(footer());
  EXPECT_EQ(unflushed.bytes(), file.bytes());
  const Record whole = read_record(file.path());
  EXPECT_EQ(whole.damage, "");
  EXPECT_EQ(whole.interactions.size(), 5U);
  EXPECT_TRUE(whole.footer.has_value());
}

TEST(Recorder, TextsThatAreNotUtf8AreRepaired) {
  const TemporaryFile file;
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  Footer end = footer();
  end.reason = "bad \xFF";
  recorder->write(end);
  EXPECT_EQ(read_record(file.path()).footer->reason, "bad \xEF\xBF\xBD");
}

TEST(ReadRecord, RejectsFilesThatAreNotRecords) {
  const TemporaryFile file;
  const auto expect_rejected = [](const std::filesystem::path& path) {
    EXPECT_EQ(bad_file_error([&] { read_record(path); }).where().file, path);
  };
  expect_rejected("/nonexistent/record.mcap");
  expect_rejected(::testing::TempDir());
  for (const char* bytes : {"", "PK\x03\x04 a zip file"}) {
    file.set_bytes(bytes);
    expect_rejected(file.path());
  }
  McapWriter(file.path(), "without a header").finish();
  expect_rejected(file.path());
  McapWriter newer(file.path(), "tether");
  newer.add_metadata("tether", {{"schema_version", "2"}});
  newer.finish();
  expect_rejected(file.path());
}

TEST(Recorder, BatteriesAreReadBack) {
  const TemporaryFile file;
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  recorder->write(st_ms(40), battery());
  recorder->write(footer());
  const Record read = read_record(file.path());
  ASSERT_EQ(read.batteries.size(), 1U);
  EXPECT_EQ(read.batteries[0].message, battery());
  EXPECT_EQ(last_time(read), st_ms(40));
}

TEST(Margins, AreWrittenInTheOrderOfTime) {
  const TemporaryFile file, sorted;
  const Margin early{"a", "near", st_ms(1), 2.5, "m"}, late{"a", "in time", st_ms(3), -0.5, "s"};
  write_margins(file.path(), {late, early});
  write_margins(sorted.path(), {early, late});
  EXPECT_EQ(file.bytes(), sorted.bytes());
  EXPECT_NE(file.bytes().find("/margins/a"), std::string::npos);
}

TEST(ReadRecord, SkipsUnknownChannelsAndMetadata) {
  const TemporaryFile file;
  McapWriter writer(file.path(), "tether");
  writer.add_metadata("other", {});
  writer.add_metadata("tether", to_metadata(header()));
  const auto schema = writer.add_schema("tether.LaterInvention", "jsonschema", "{}");
  const auto channel = writer.add_channel("/later", schema, "json");
  writer.begin_message(channel, 5) += "whatever";
  writer.end_message();
  writer.finish();
  EXPECT_EQ(read_record(file.path()).damage, "");
}

}  // namespace
}  // namespace tether::record
