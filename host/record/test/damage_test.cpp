#include "bytes.h"
#include "json_messages.h"
#include "mcap_format.h"
#include "sample_messages.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/random.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/record/reader.h>

namespace tether::record {
namespace {

template <class Message>
std::string line(SimTime at, const Message& message) {
  std::string text = std::to_string(to_ns(at)) + " ns: ";
  append_json(text, message);
  return text;
}

struct Written {
  std::string bytes;
  std::vector<SimTime> times;
  std::vector<std::string> lines;  // of every message, in the order of writing
};

// Four seconds in four chunks, so that something is left before a truncation.
Written small_record() {
  const TemporaryFile file;
  Written written;
  const auto recorder = make_mcap_recorder(file.path());
  const auto write = [&](SimTime at, const auto& message) {
    recorder->write(at, message);
    written.times.push_back(at);
    written.lines.push_back(line(at, message));
  };
  recorder->write(header());
  for (std::int64_t ms = 0; ms < 4000; ms += 500) {
    write(st_ms(ms), ground_truth(ms));
    write(st_ms(ms), command_effect(static_cast<std::uint64_t>(ms)));
    write(st_ms(ms), annotation());
  }
  recorder->write(footer());
  written.bytes = file.bytes();
  return written;
}

constexpr std::size_t kMessages = 8;  // of ground truth

struct Outcome {
  bool refused = false;
  std::size_t messages = 0;  // of ground truth
  std::map<std::uint64_t, std::string> lines;
  std::string damage;
  bool has_end = false;
};

template <class Message>
void add_lines(Outcome& outcome, const std::vector<Logged<Message>>& topic) {
  for (const Logged<Message>& logged : topic) {
    EXPECT_TRUE(outcome.lines.emplace(logged.order, line(logged.at, logged.message)).second);
  }
}

Outcome read(const TemporaryFile& file) {
  Outcome outcome;
  try {
    const Record record = read_record(file.path(), {.images = true});
    outcome.messages = record.ground_truth.size();
    add_lines(outcome, record.ground_truth);
    add_lines(outcome, record.commands);
    add_lines(outcome, record.annotations);
    outcome.damage = record.damage;
    outcome.has_end = record.footer.has_value();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    outcome.refused = true;
  }
  return outcome;
}

// A record of the container (https://mcap.dev/spec), and of a chunk its latest log time.
struct Span {
  Opcode opcode{};
  std::size_t start = 0;
  std::size_t end = 0;
  SimTime latest{};
};

// Walks over opcodes and lengths alone. The magic at the end is the last span.
std::vector<Span> spans_of(const std::string& file) {
  std::vector<Span> spans;
  std::size_t at = kMagic.size();
  while (at + kMagic.size() < file.size()) {
    FieldReader fields(std::string_view(file).substr(at));
    Span span{static_cast<Opcode>(fields.u8()), at};
    at += kRecordPrefixBytes + fields.u64();
    span.end = at;
    if (span.opcode == Opcode::kChunk) {
      fields.u64();  // earliest log time
      span.latest = from_ns<SimTime>(static_cast<std::int64_t>(fields.u64()));
    }
    spans.push_back(span);
  }
  EXPECT_EQ(at + kMagic.size(), file.size());
  spans.push_back({Opcode{}, at, file.size()});
  return spans;
}

// What is complete in the first `length` bytes of the file.
struct Whole {
  std::size_t messages = 0;
  std::size_t metadata = 0;
  std::size_t damaged_at = 0;  // start of the first record that is not complete
};

Whole whole_before(std::size_t length, const std::vector<Span>& spans, const Written& written) {
  Whole whole;
  for (const Span& span : spans) {
    whole.damaged_at = span.start;
    if (span.end > length) break;
    whole.metadata += span.opcode == Opcode::kMetadata ? 1 : 0;
    if (span.opcode != Opcode::kChunk) continue;
    const auto& times = written.times;
    const auto behind = std::upper_bound(times.begin(), times.end(), span.latest);
    whole.messages = static_cast<std::size_t>(behind - times.begin());
  }
  return whole;
}

std::map<std::uint64_t, std::string> first_lines(const Written& written, std::size_t count) {
  std::map<std::uint64_t, std::string> lines;
  for (std::size_t i = 0; i < count; ++i) {
    lines.emplace(i, written.lines[i]);
  }
  return lines;
}

TEST(Damage, ATruncatedRecordGivesAllMessagesOfCompleteChunks) {
  const Written written = small_record();
  const std::vector<Span> spans = spans_of(written.bytes);
  const TemporaryFile file;
  std::set<std::size_t> messages;
  for (std::size_t length = 0; length <= written.bytes.size(); ++length) {
    SCOPED_TRACE(length);
    file.set_bytes(written.bytes.substr(0, length));
    const Whole whole = whole_before(length, spans, written);
    const Outcome outcome = read(file);
    ASSERT_EQ(outcome.refused, whole.metadata == 0) << "needs the header and no more";
    if (outcome.refused) continue;
    messages.insert(whole.messages);
    ASSERT_EQ(outcome.lines, first_lines(written, whole.messages));
    ASSERT_EQ(outcome.has_end, whole.metadata == 2);
    const std::string place = "damaged at byte " + std::to_string(whole.damaged_at) + ": ";
    if (length == written.bytes.size()) {
      ASSERT_EQ(outcome.damage, "");
    } else {
      ASSERT_TRUE(outcome.damage.starts_with(place)) << outcome.damage;
    }
  }
  EXPECT_EQ(messages, (std::set<std::size_t>{0, 6, 12, 18, 24})) << "four chunks";
}

// Whether each message is one that was written, and they come in the order of writing.
bool are_written(const Outcome& outcome, const Written& written) {
  auto next = written.lines.begin();
  return std::all_of(outcome.lines.begin(), outcome.lines.end(), [&](const auto& message) {
    const auto found = std::find(next, written.lines.end(), message.second);
    if (found == written.lines.end()) return false;
    next = found + 1;
    return true;
  });
}

TEST(Damage, EveryFlippedBitIsDetectedAndChangesNoMessage) {
  const Written whole = small_record();
  const TemporaryFile file;
  for (std::size_t bit = 0; bit < whole.bytes.size() * 8; bit += 11) {
    SCOPED_TRACE(bit);
    std::string flipped = whole.bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    file.set_bytes(flipped);
    const Outcome outcome = read(file);
    ASSERT_TRUE(outcome.refused || !outcome.damage.empty());
    ASSERT_TRUE(are_written(outcome, whole));
    // Messages are missing only behind the damage, or the damage says that they may be anywhere.
    if (outcome.damage.find("CRC mismatch of the data section") == std::string::npos) {
      ASSERT_EQ(outcome.lines, first_lines(whole, outcome.lines.size()));
    }
  }
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
  const std::string whole = small_record().bytes;
  const TemporaryFile file;
  KeyedRandom random({.seed = 11});
  for (int round = 0; round < 3000; ++round) {
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
    EXPECT_LE(read(file).messages, kMessages * 2);
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

/// A message of sequence 42 that is not a ground truth message, under that topic.
std::string wrong_message(const std::string& topic) {
  std::string schema, channel, message;
  append_u16(schema, 1);
  append_string(schema, "tether.GroundTruth");
  append_string(schema, "");
  append_string(schema, "");
  append_u16(channel, 7);
  append_u16(channel, 1);
  append_string(channel, topic);
  append_string(channel, "json");
  append_u32(channel, 0);
  append_u16(message, 7);
  append_u32(message, 42);
  append_u64(message, 0);
  append_u64(message, 0);
  return raw_record(Opcode::kSchema, schema) + raw_record(Opcode::kChannel, channel) +
         raw_record(Opcode::kMessage, message + "{\"uav\":3}");
}

TEST(Damage, WrongMessageIsNamedWithItsTopicInOnePrintableLine) {
  for (const auto& [topic, printed] :
       {std::pair("/ground_truth/a", "/ground_truth/a"), std::pair("/a\nb\x1b[2J", "/a?b?[2J")}) {
    TemporaryFile file;
    make_mcap_recorder(file.path())->write(header());
    file.set_bytes(file.bytes() + wrong_message(topic));
    const std::string damage = read(file).damage;
    EXPECT_TRUE(damage.ends_with("message 42 of " + std::string(printed) +
                                 ": member \"uav\" is not a string"))
        << damage;
  }
}

}  // namespace
}  // namespace tether::record
