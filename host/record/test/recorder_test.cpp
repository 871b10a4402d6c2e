#include "bytes.h"
#include "mcap_format.h"
#include "mcap_writer.h"
#include "sample_messages.h"

#include <string>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/record/canonical.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>

namespace tether::record {
namespace {

TEST(Recorder, WholeRecordReadsBack) {
  const TemporaryFile file;
  write_whole_record(file.path());
  const Record record = read_record(file.path(), {.images = true});
  EXPECT_EQ(record.damage, "");
  EXPECT_EQ(record.header.condition, "target, no sync");
  ASSERT_EQ(record.interactions.size(), 4U);
  EXPECT_EQ(record.interactions[0].at, st_ms(37));
  EXPECT_EQ(record.interactions[0].message.uav, sensor_interaction().uav);
  EXPECT_EQ(record.interactions[2].message.sleep_until, et_ns(50'000'000));
  ASSERT_EQ(record.commands.size(), 1U);
  EXPECT_EQ(record.commands[0].message.yaw_rate_rad_s, 1.0 / 3.0);
  ASSERT_EQ(record.ground_truth.size(), 1U);
  EXPECT_EQ(record.ground_truth[0].message.w_WB_B_rad_s[2], -1.7976931348623157e308);
  ASSERT_EQ(record.annotations.size(), 1U);
  EXPECT_EQ(record.annotations[0].message.json, annotation().json);
  ASSERT_EQ(record.stops.size(), 1U);
  EXPECT_EQ(record.stops[0].at, st_ms(50));
  EXPECT_EQ(record.stops[0].message.reply_at, et_ns(50'000'000));
  EXPECT_FALSE(record.header.suts[0].concurrent);
  EXPECT_TRUE(record.header.suts[1].concurrent);
  ASSERT_EQ(record.images.size(), 1U);
  EXPECT_EQ(record.images[0].message.png, image().png);
  EXPECT_EQ(record.images[0].message.at, image().at);
  ASSERT_TRUE(record.footer.has_value());
  EXPECT_EQ(record.footer->et_at_end, footer().et_at_end);
  EXPECT_EQ(record.footer->stops, 1U);
  EXPECT_EQ(record.footer->largest_overshoot, Duration(321));
}

TEST(Recorder, OrderIsTheFilesWhateverIsLoaded) {
  const TemporaryFile file;
  write_whole_record(file.path());
  for (const bool images : {false, true}) {
    const Record record = read_record(file.path(), {.images = images});
    EXPECT_EQ(record.interactions[0].order, 0U);
    EXPECT_EQ(record.annotations[0].order, 1U);
    EXPECT_EQ(record.interactions[1].order, 2U);
    EXPECT_EQ(record.ground_truth[0].order, 3U);
    EXPECT_EQ(record.commands[0].order, 4U);
    EXPECT_EQ(record.interactions[2].order, 6U);
    EXPECT_EQ(record.images.size(), images ? 1U : 0U);
  }
}

TEST(Recorder, SameMessagesSameBytes) {
  const TemporaryFile one;
  const TemporaryFile two;
  write_whole_record(one.path());
  write_whole_record(two.path());
  EXPECT_EQ(one.bytes(), two.bytes());
}

TEST(Recorder, WithoutFooterEverythingIsThereAndTheEndIsMissing) {
  const TemporaryFile file;
  write_messages(*make_mcap_recorder(file.path()));
  const Record record = read_record(file.path());
  EXPECT_EQ(record.interactions.size(), 4U);
  EXPECT_FALSE(record.footer.has_value());
  EXPECT_NE(record.damage.find("ends too early"), std::string::npos) << record.damage;
}

// What a killed process leaves: all but the last second.
TEST(Recorder, ChunksAreInTheFileWhileTheRunGoesOn) {
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

// What a killed process leaves: all up to the last flush.
TEST(Recorder, WhatWasFlushedIsInTheFile) {
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
  const Record whole = read_record(file.path());
  EXPECT_EQ(whole.damage, "");
  EXPECT_EQ(whole.interactions.size(), 5U);
  EXPECT_TRUE(whole.footer.has_value());
}

TEST(Recorder, NullRecorderTakesEverything) {
  const auto recorder = make_null_recorder();
  write_messages(*recorder);
  recorder->flush();
  recorder->write(footer());
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

void expect_bad_file(const std::filesystem::path& path, const std::string& what) {
  try {
    read_record(path);
    FAIL() << what;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

TEST(ReadRecord, RefusesWhatIsNoRecord) {
  expect_bad_file("/nonexistent/record.mcap", "cannot read");
  expect_bad_file(::testing::TempDir(), "cannot read");
  const TemporaryFile file;
  file.set_bytes("");
  expect_bad_file(file.path(), "not an MCAP file");
  file.set_bytes("PK\x03\x04 something else entirely");
  expect_bad_file(file.path(), "not an MCAP file");
}

TEST(ReadRecord, RefusesTheMcapOfOthers) {
  const TemporaryFile file;
  McapWriter writer(file.path(), "other");
  writer.finish();
  expect_bad_file(file.path(), "not a record of Tether's");
}

TEST(ReadRecord, RefusesANewerSchema) {
  const TemporaryFile file;
  McapWriter writer(file.path(), "tether");
  writer.add_metadata("tether", {{"schema_version", "2"}});
  writer.finish();
  expect_bad_file(file.path(), "newer Tether");
}

TEST(ReadRecord, PassesOverChannelsItDoesNotKnow) {
  const TemporaryFile file;
  McapWriter writer(file.path(), "tether");
  writer.add_metadata("other", {});
  const auto schema = writer.add_schema("tether.LaterInvention", "jsonschema", "{}");
  const auto channel = writer.add_channel("/later", schema, "json");
  writer.begin_message(channel, 5) += "whatever";
  writer.end_message();
  writer.finish();
  expect_bad_file(file.path(), "not a record of Tether's");  // only for want of a header
}

}  // namespace
}  // namespace tether::record
