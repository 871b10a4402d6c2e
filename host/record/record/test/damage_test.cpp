#include "json/json_messages.h"
#include "raw_records.h"
#include "sample_messages.h"

#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/random.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/record/reader.h>

namespace tether::record {
namespace {

constexpr std::size_t kChunks = 4;
constexpr std::size_t kMessagesPerChunk = 6;

// Four seconds, so that something is left before a truncation.
void write_small_record(const TemporaryFile& file) {
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  for (std::int64_t ms = 0; ms < 4000; ms += 500) {
    recorder->write(st_ms(ms), ground_truth(ms));
    recorder->write(st_ms(ms), command_effect(static_cast<std::uint64_t>(ms)));
    recorder->flush();
    recorder->write(st_ms(ms), annotation());
  }
  recorder->write(footer());
}
std::string small_record() {
  const TemporaryFile file;
  write_small_record(file);
  return file.bytes();
}

struct Outcome {
  bool refused = false;
  std::vector<std::string> lines;  // of the messages, in the order of the file
  std::string damage;
  bool has_end = false;
};

Outcome read(const TemporaryFile& file) {
  Outcome outcome;
  try {
    const Record record = read_record(file.path(), {.images = true});
    std::map<std::uint64_t, std::string> lines;
    const auto add = [&](const auto& topic) {
      for (const auto& [at, order, message] : topic) {
        std::string text = std::to_string(to_ns(at)) + " ns: ";
        append_json(text, message);
        EXPECT_TRUE(lines.emplace(order, text).second);
      }
    };
    add(record.ground_truth);
    add(record.commands);
    add(record.annotations);
    for (const auto& [order, line] : lines) outcome.lines.push_back(line);
    outcome.damage = record.damage;
    outcome.has_end = record.footer.has_value();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    outcome.refused = true;
  }
  return outcome;
}

/// Lengths to truncate a file to: around each end of a record, and some between.
std::set<std::size_t> truncated_lengths(const std::vector<Raw>& records, std::size_t whole) {
  std::set<std::size_t> lengths;
  for (std::size_t length = 0; length < whole; length += 31) lengths.insert(length);
  for (const Raw& raw : records)
    for (const std::size_t length : {raw.end() - 1, raw.end(), raw.end() + 1})
      if (length < whole) lengths.insert(length);
  return lengths;
}

std::vector<std::string> first_of(const std::vector<std::string>& lines, std::size_t count) {
  return {lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(Damage, ATruncatedRecordGivesAllMessagesOfCompleteChunks) {
  const std::string whole = small_record();
  const std::vector<Raw> records = raw_records(whole);
  const auto complete = [&](Opcode opcode, std::size_t length) {
    return static_cast<std::size_t>(std::ranges::count_if(
        records, [&](const Raw& raw) { return raw.opcode == opcode && raw.end() <= length; }));
  };
  ASSERT_EQ(complete(Opcode::kChunk, whole.size()), kChunks);
  const TemporaryFile file;
  file.set_bytes(whole);
  const Outcome all = read(file);
  EXPECT_EQ(all.damage, "");
  EXPECT_TRUE(all.has_end);
  ASSERT_EQ(all.lines.size(), kChunks * kMessagesPerChunk);
  for (const std::size_t length : truncated_lengths(records, whole.size())) {
    SCOPED_TRACE(length);
    file.set_bytes(whole.substr(0, length));
    const Outcome outcome = read(file);
    const std::size_t metadata = complete(Opcode::kMetadata, length);
    ASSERT_EQ(outcome.refused, metadata == 0) << "needs the header and no more";
    if (outcome.refused) continue;
    ASSERT_EQ(outcome.lines,
              first_of(all.lines, kMessagesPerChunk * complete(Opcode::kChunk, length)));
    ASSERT_EQ(outcome.has_end, metadata == 2);
    const auto damaged = std::ranges::upper_bound(records, length, {}, &Raw::end);
    const std::size_t place = damaged == records.end() ? records.back().end() : damaged->offset;
    ASSERT_TRUE(outcome.damage.starts_with("damaged at byte " + std::to_string(place) + ": "))
        << outcome.damage;
  }
}

/// No file of this process can grow beyond that size.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::size_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  sighandler_t handler_ = ::signal(SIGXFSZ, SIG_IGN);
};

TEST(Damage, AFullDiskLeavesAllMessagesThatFit) {
  const std::string whole = small_record();
  const std::vector<Raw> records = raw_records(whole);
  const TemporaryFile file;
  file.set_bytes(whole);
  const Outcome all = read(file);
  for (std::size_t size = 0; size < whole.size(); size += 47) {
    SCOPED_TRACE(size);
    {
      const FileSizeLimit limit(size);
      EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { write_small_record(file); }).where().file,
                file.path());
    }
    // Parts: the header, each chunk, its indices, the footer. What follows is one part.
    std::size_t kept = 0, chunks = 0, metadata = 0;
    for (const Raw& raw : records) {
      if (raw.end() > size) break;
      if (raw.opcode == Opcode::kChunk) ++chunks;
      if (raw.opcode == Opcode::kMetadata) ++metadata;
      if (raw.opcode != Opcode::kDataEnd) kept = raw.end();
    }
    EXPECT_TRUE(whole.starts_with(file.bytes()));
    EXPECT_LE(file.bytes().size(), kept);
    const Outcome outcome = read(file);
    ASSERT_EQ(outcome.refused, metadata == 0);
    EXPECT_EQ(outcome.lines, first_of(all.lines, kMessagesPerChunk * chunks));
    EXPECT_EQ(outcome.has_end, metadata == 2);
    EXPECT_EQ(outcome.damage.empty(), outcome.refused);
  }
}

// Whether the messages are some of those that were written, in the same order.
bool are_written(const std::vector<std::string>& lines, const std::vector<std::string>& written) {
  auto next = written.begin();
  return std::ranges::all_of(lines, [&](const std::string& line) {
    next = std::find(next, written.end(), line);
    return next != written.end() && next++ != written.end();
  });
}

TEST(Damage, EveryFlippedBitIsDetectedAndChangesNoMessage) {
  const std::string whole = small_record();
  const TemporaryFile file;
  file.set_bytes(whole);
  const std::vector<std::string> written = read(file).lines;
  for (std::size_t bit = 0; bit < whole.size() * 8; bit += 101) {
    SCOPED_TRACE(bit);
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    file.set_bytes(flipped);
    const Outcome outcome = read(file);
    ASSERT_TRUE(outcome.refused || !outcome.damage.empty());
    ASSERT_TRUE(are_written(outcome.lines, written));
    // Messages are missing only after the damage, or the damage may be anywhere.
    if (!outcome.damage.ends_with("CRC mismatch of the data section")) {
      ASSERT_EQ(outcome.lines, first_of(written, outcome.lines.size()));
    }
  }
  file.set_bytes(whole + "x");
  EXPECT_NE(read(file).damage, "");
}

TEST(Damage, APipeIsRejectedWithoutWaitingForAWriter) {
  const ScratchFolder folder;
  const std::filesystem::path pipe = folder.path("record.mcap");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::alarm(60);  // ends the test if it waits
  EXPECT_EQ(bad_file_error([&] { read_record(pipe); }).where().file, pipe);
  ::alarm(0);
}

TEST(Damage, RandomChangesNeverCrash) {
  const std::string whole = small_record();
  const TemporaryFile file;
  KeyedRandom random({.seed = 11});
  for (int round = 0; round < 1000; ++round) {
    std::string changed = whole;
    for (unsigned changes = 1 + random.bits() % 8; changes > 0; --changes) {
      const std::size_t at = random.bits() % changed.size();
      switch (random.bits() % 4) {
        case 0:
          changed[at] = static_cast<char>(random.bits());
          break;
        case 1:
          changed.erase(at, random.bits() % 16);
          break;
        case 2:
          changed.insert(at, std::string(random.bits() % 16, static_cast<char>(random.bits())));
          break;
        default:  // a length field gone wild
          changed.replace(at, 8, std::string(8, '\xFF'));
      }
    }
    file.set_bytes(changed);
    EXPECT_LE(read(file).lines.size(), 2 * kChunks * kMessagesPerChunk);
  }
}

std::string raw_record(Opcode opcode, const std::string& content) {
  std::string out;
  append_u8(out, static_cast<std::uint8_t>(opcode));
  append_u64(out, content.size());
  return out + content;
}

std::string raw_chunk(std::uint64_t size, std::uint32_t crc, const std::string& compression,
                      const std::string& records) {
  std::string content;
  append_u64(content, 0);
  append_u64(content, 0);
  append_u64(content, size);
  append_u32(content, crc);
  append_string(content, compression);
  append_u64(content, records.size());
  return raw_record(Opcode::kChunk, content + records);
}

// The damage of a file that has Tether's header and then `rest`, without its place.
std::string damage_of(const std::string& rest) {
  const TemporaryFile file;
  make_mcap_recorder(file.path())->write(header());
  const std::string front = file.bytes();
  file.set_bytes(front + rest);
  const std::string damage = read(file).damage;
  const std::string place = "damaged at byte " + std::to_string(front.size()) + ": ";
  return damage.starts_with(place) ? damage.substr(place.size()) : "elsewhere: " + damage;
}

TEST(Damage, EachKindOfBadChunkIsReported) {
  const std::string message = raw_record(Opcode::kMessage, std::string(22, '\0'));
  const std::string inner = raw_chunk(0, 0, "", "");
  const std::pair<std::string, std::string> cases[] = {
      {raw_chunk(1ULL << 60, 0, "zstd", ""), "a chunk unpacks to more than the size limit"},
      {raw_chunk(10 << 20, 0, "zstd", "junk"), "the compressed data of a chunk is damaged"},
      {raw_chunk(5, 0, "", "1234"), "the size of a chunk differs from its header"},
      {raw_chunk(4, 0, "lz4", "1234"),
       "a chunk is compressed with \"lz4\". Only zstd is supported"},
      {raw_chunk(message.size(), 1, "", message), "CRC mismatch of a chunk"},
      {raw_chunk(message.size(), 0, "", message), "a message has an unknown channel"},
      {raw_chunk(inner.size(), 0, "", inner), "a chunk contains a chunk"}};
  for (const auto& [chunk, damage] : cases) EXPECT_EQ(damage_of(chunk), damage);
}

/// A channel of ground truth under that topic, and its messages of these numbers, outside a chunk.
std::string numbered_messages(const std::string& topic, const std::vector<std::uint32_t>& sequences,
                              const std::string& json) {
  std::string schema, channel, messages;
  append_u16(schema, 1);
  append_string(schema, "tether.GroundTruth");
  append_string(schema, "");
  append_string(schema, "");
  append_u16(channel, 7);
  append_u16(channel, 1);
  append_string(channel, topic);
  append_string(channel, "json");
  append_u32(channel, 0);
  for (const std::uint32_t sequence : sequences) {
    std::string message;
    append_u16(message, 7);
    append_u32(message, sequence);
    append_u64(message, 1000 + sequence);
    append_u64(message, 0);
    messages += raw_record(Opcode::kMessage, message + json);
  }
  return raw_record(Opcode::kSchema, schema) + raw_record(Opcode::kChannel, channel) + messages;
}

TEST(Damage, MessagesThatWereRemovedRepeatedOrMovedAreMiscounted) {
  using Numbers = std::vector<std::uint32_t>;
  using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // expected, found
  std::string json;
  append_json(json, ground_truth(0));
  for (const auto& [numbers, expected] : {std::pair(Numbers{0, 1, 2}, Pairs{}),
                                          {{0, 1, 3, 4}, {{2, 3}}},
                                          {{1, 2}, {{0, 1}}},
                                          {{0, 1, 1, 2}, {{2, 1}}},
                                          {{0, 2, 1, 3}, {{1, 2}, {3, 1}, {2, 3}}}}) {
    TemporaryFile file;
    make_mcap_recorder(file.path())->write(header());
    file.set_bytes(file.bytes() + numbered_messages("/ground_truth/a", numbers, json));
    Pairs found;
    for (const Miscount& miscount : read_record(file.path()).miscounts) {
      EXPECT_EQ(miscount.topic, "/ground_truth/a");
      EXPECT_EQ(to_ns(miscount.at), 1000 + static_cast<std::int64_t>(miscount.found));
      found.emplace_back(miscount.expected, miscount.found);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(Damage, WrongMessageIsNamedWithItsTopicInOnePrintableLine) {
  for (const auto& [topic, printed] :
       {std::pair("/ground_truth/a", "/ground_truth/a"), std::pair("/a\nb\x1b[2J", "/a?b?[2J")}) {
    TemporaryFile file;
    make_mcap_recorder(file.path())->write(header());
    file.set_bytes(file.bytes() + numbered_messages(topic, {42}, "{\"uav\":3}"));
    const std::string damage = read(file).damage;
    EXPECT_TRUE(damage.ends_with("message 42 of " + std::string(printed) +
                                 ": member \"uav\" is not a string"))
        << damage;
  }
}

}  // namespace
}  // namespace tether::record
