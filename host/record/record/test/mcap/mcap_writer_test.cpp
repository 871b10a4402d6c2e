#include "mcap/mcap_writer.h"

#include "mcap/mcap_reader.h"
#include "raw_records.h"
#include "sample_messages.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::record {
namespace {

class Collector : public McapVisitor {
 public:
  void channel(const McapChannel& channel) override {
    topics[channel.id] = channel.topic;
    schema_names[channel.id] = channel.schema_name;
  }
  void message(const McapMessage& message) override {
    messages.emplace_back(topics.at(message.channel), message.sequence, message.log_time_ns,
                          std::string(message.data));
    EXPECT_EQ(message.publish_time_ns, message.log_time_ns);
  }
  void metadata(std::string_view name, const StringMap& values) override {
    all_metadata.emplace_back(name, values);
  }

  std::map<std::uint16_t, std::string> topics;
  std::map<std::uint16_t, std::string> schema_names;
  std::vector<std::tuple<std::string, std::uint32_t, std::uint64_t, std::string>> messages;
  std::vector<std::pair<std::string, StringMap>> all_metadata;
};

// Two channels, a message every 10 ms on one and every 30 ms on the other.
void write_file(const std::filesystem::path& path, int messages, ChunkLimits limits = {}) {
  McapWriter writer(path, "test", limits);
  writer.add_metadata("first", {{"a", "1"}, {"b", ""}});
  const std::uint16_t schema = writer.add_schema("s", "jsonschema", "{}");
  const std::uint16_t often = writer.add_channel("/often", schema, "json");
  const std::uint16_t seldom = writer.add_channel("/seldom", 0, "json");
  for (int i = 0; i < messages; ++i) {
    const auto time = static_cast<std::uint64_t>(i) * 10'000'000;
    writer.begin_message(often, time) += "{\"i\":" + std::to_string(i) + "}";
    writer.end_message();
    if (i % 3 == 0) {
      writer.begin_message(seldom, time) += "{}";
      writer.end_message();
    }
  }
  writer.add_metadata("last", {});
  writer.finish();
}

TEST(McapWriter, ReadsBack) {
  const TemporaryFile file;
  write_file(file.path(), 250);
  Collector collector;
  EXPECT_EQ(read_mcap(file.path(), collector), "");
  ASSERT_EQ(collector.messages.size(), 250U + 84U);
  EXPECT_EQ(collector.messages[0], std::tuple("/often", 0U, 0U, "{\"i\":0}"));
  EXPECT_EQ(collector.messages[1], std::tuple("/seldom", 0U, 0U, "{}"));
  EXPECT_EQ(collector.messages.back(), std::tuple("/seldom", 83U, 2'490'000'000U, "{}"));
  EXPECT_EQ(collector.schema_names[1], "s");
  EXPECT_EQ(collector.schema_names[2], "");
  ASSERT_EQ(collector.all_metadata.size(), 2U);
  EXPECT_EQ(collector.all_metadata[0].second, (StringMap{{"a", "1"}, {"b", ""}}));
}

std::vector<Raw> of_kind(const std::vector<Raw>& records, Opcode opcode) {
  std::vector<Raw> found;
  std::ranges::copy_if(records, std::back_inserter(found),
                       [&](const Raw& record) { return record.opcode == opcode; });
  return found;
}

// Of 250 messages: chunks of [0, 1 s), [1 s, 2 s) and [2 s, 2.49 s].
class McapFile : public testing::Test {
 protected:
  TemporaryFile file_;
  const std::string bytes_ = (write_file(file_.path(), 250), file_.bytes());
  const std::vector<Raw> records_ = raw_records(bytes_);
};

TEST_F(McapFile, ChunkIndicesPointAtChunksAndMessageIndices) {
  std::map<std::uint64_t, Raw> by_offset;
  for (const Raw& record : records_) by_offset.emplace(record.offset, record);
  const std::vector<Raw> indices = of_kind(records_, Opcode::kChunkIndex);
  EXPECT_EQ(indices.size(), 3U);
  EXPECT_EQ(of_kind(records_, Opcode::kChunk).size(), 3U);
  for (const Raw& record : indices) {
    FieldReader fields(record.content);
    const std::uint64_t first = fields.u64();
    EXPECT_LE(first, fields.u64());
    const Raw chunk = by_offset.at(fields.u64());
    EXPECT_EQ(chunk.opcode, Opcode::kChunk);
    EXPECT_EQ(fields.u64(), chunk.content.size() + kRecordPrefixBytes);
    FieldReader map(fields.string());
    std::uint64_t index_bytes = 0;
    while (!map.empty()) {
      const std::uint16_t channel = map.u16();
      const Raw index = by_offset.at(map.u64());
      EXPECT_EQ(index.opcode, Opcode::kMessageIndex);
      index_bytes += index.content.size() + kRecordPrefixBytes;
      EXPECT_EQ(FieldReader(index.content).u16(), channel);
    }
    EXPECT_EQ(fields.u64(), index_bytes);
    EXPECT_EQ(fields.string(), "zstd");
  }
}

TEST_F(McapFile, StatisticsCountEverything) {
  const std::vector<Raw> found = of_kind(records_, Opcode::kStatistics);
  ASSERT_EQ(found.size(), 1U);
  FieldReader fields(found[0].content);
  EXPECT_EQ(fields.u64(), 250U + 84U);
  EXPECT_EQ(fields.u16(), 1U);  // schemas
  EXPECT_EQ(fields.u32(), 2U);  // channels
  EXPECT_EQ(fields.u32(), 0U);  // attachments
  EXPECT_EQ(fields.u32(), 2U);  // metadata
  EXPECT_EQ(fields.u32(), 3U);  // chunks
  EXPECT_EQ(fields.u64(), 0U);
  EXPECT_EQ(fields.u64(), 2'490'000'000U);
  FieldReader counts(fields.string());
  for (const auto& [channel, messages] : {std::pair(1U, 250U), std::pair(2U, 84U)}) {
    EXPECT_EQ(counts.u16(), channel);
    EXPECT_EQ(counts.u64(), messages);
  }
}

TEST_F(McapFile, SummaryOffsetsNameTheGroups) {
  const Raw& footer = records_.back();
  ASSERT_EQ(footer.opcode, Opcode::kFooter);
  std::uint64_t next_group = FieldReader(footer.content).u64();
  std::set<Opcode> groups;
  for (const Raw& record : of_kind(records_, Opcode::kSummaryOffset)) {
    FieldReader fields(record.content);
    groups.insert(static_cast<Opcode>(fields.u8()));
    EXPECT_EQ(fields.u64(), next_group);
    next_group += fields.u64();
  }
  EXPECT_EQ(groups, (std::set{Opcode::kSchema, Opcode::kChannel, Opcode::kChunkIndex,
                              Opcode::kMetadataIndex, Opcode::kStatistics}));
}

TEST_F(McapFile, MetadataIndicesPointAtMetadata) {
  std::vector<std::string> names;
  for (const Raw& record : of_kind(records_, Opcode::kMetadataIndex)) {
    FieldReader fields(record.content);
    const std::uint64_t offset = fields.u64();
    FieldReader target(std::string_view(bytes_).substr(offset, fields.u64()));
    EXPECT_EQ(target.u8(), static_cast<std::uint8_t>(Opcode::kMetadata));
    const std::uint64_t content_length = target.u64();
    EXPECT_EQ(content_length, target.size());
    names.emplace_back(target.string());
    EXPECT_EQ(fields.string(), names.back());
  }
  EXPECT_EQ(names, (std::vector<std::string>{"first", "last"}));
}

TEST(McapWriter, WritesAChunkWhenItIsFull) {
  const TemporaryFile file;
  write_file(file.path(), 50, {.bytes = 400, .span_ns = 1'000'000'000'000});
  const std::string bytes = file.bytes();
  const auto records = raw_records(bytes);
  const std::vector<Raw> chunks = of_kind(records, Opcode::kChunk);
  EXPECT_GT(chunks.size(), 5U);
  for (const Raw& chunk : chunks) {
    FieldReader fields(chunk.content);
    fields.bytes(16);
    EXPECT_LT(fields.u64(), 400U + 60U);  // one message more than the limit at most
  }
}

TEST(McapWriter, MessageIndexPointsAtMessages) {
  const TemporaryFile file;
  // One small chunk; its records begin with schema and channels.
  write_file(file.path(), 5);
  const std::string bytes = file.bytes();
  int entries = 0;
  for (const Raw& record : of_kind(raw_records(bytes), Opcode::kMessageIndex)) {
    FieldReader fields(record.content);
    const std::uint16_t channel = fields.u16();
    FieldReader list(fields.string());
    for (std::uint64_t previous = 0; !list.empty(); ++entries) {
      EXPECT_EQ(list.u64() % (channel == 1 ? 10'000'000U : 30'000'000U), 0U);
      const std::uint64_t offset = list.u64();
      EXPECT_GT(offset, previous);
      previous = offset;
    }
  }
  EXPECT_EQ(entries, 5 + 2);
}

// /dev/full refuses every write.
TEST(McapWriter, NamesTheFileThatItCannotWrite) {
  for (const char* path : {"/nonexistent/folder/record.mcap", "/dev/full"}) {
    const Error error = thrown_error(ErrorCode::kSetup, [&] { McapWriter(path, "test"); });
    EXPECT_EQ(error.where().file, path);
  }
}

}  // namespace
}  // namespace tether::record
