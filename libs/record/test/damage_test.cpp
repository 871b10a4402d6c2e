#include "bytes.h"
#include "mcap_format.h"
#include "sample_messages.h"

#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/record/reader.h>

namespace tether::record {
namespace {

// Four seconds of ground truth in four chunks, so that a tear leaves something before it.
std::string small_file() {
  const TemporaryFile file;
  const auto recorder = make_mcap_recorder(file.path());
  recorder->write(header());
  for (std::int64_t ms = 0; ms < 4000; ms += 500) {
    recorder->write(st_ms(ms), ground_truth(ms));
    recorder->write(st_ms(ms), annotation());
  }
  recorder->write(footer());
  return file.bytes();
}

constexpr std::size_t kMessages = 8;

struct Outcome {
  bool refused = false;
  std::size_t messages = 0;
  std::string damage;
  bool has_end = false;
};

// Reads, and requires that what is there is a prefix of the undamaged messages.
Outcome read(const TemporaryFile& file) {
  Outcome outcome;
  try {
    const Record record = read_record(file.path(), {.images = true});
    outcome.messages = record.ground_truth.size();
    outcome.damage = record.damage;
    outcome.has_end = record.footer.has_value();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    outcome.refused = true;
  }
  return outcome;
}

TEST(Damage, EveryTruncationLeavesAPrefixAndANamedTear) {
  const std::string whole = small_file();
  const TemporaryFile file;
  std::size_t previous = 0;
  std::size_t refused = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    file.set_bytes(whole.substr(0, length));
    const Outcome outcome = read(file);
    if (outcome.refused) {
      EXPECT_EQ(length, refused) << "a longer file is refused although a shorter one was not";
      ++refused;
      continue;
    }
    EXPECT_GE(outcome.messages, previous);
    EXPECT_NE(outcome.damage.find("damaged at byte "), std::string::npos) << length;
    previous = outcome.messages;
  }
  EXPECT_EQ(previous, kMessages);
  file.set_bytes(whole);
  EXPECT_EQ(read(file).damage, "");
  EXPECT_TRUE(read(file).has_end);
}

TEST(Damage, EveryFlippedBitIsNoticed) {
  const std::string whole = small_file();
  const TemporaryFile file;
  for (std::size_t bit = 0; bit < whole.size() * 8; bit += 5) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    file.set_bytes(flipped);
    const Outcome outcome = read(file);
    EXPECT_TRUE(outcome.refused || !outcome.damage.empty()) << "bit " << bit;
    EXPECT_LE(outcome.messages, kMessages);
  }
}

TEST(Damage, SomethingBehindTheEndIsNoticed) {
  const TemporaryFile file;
  file.set_bytes(small_file() + "x");
  EXPECT_NE(read(file).damage, "");
}

TEST(Damage, APipeIsRefusedWithoutWaitingForItsWriter) {
  const ScratchFolder folder;
  const std::filesystem::path pipe = folder.path("record.mcap");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::alarm(60);  // ends the test if it waits
  try {
    read_record(pipe);
    ADD_FAILURE() << "read";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    EXPECT_EQ(std::string(error.what()),
              pipe.string() + ": cannot read this record; give the record.mcap of a run");
  }
  ::alarm(0);
}

TEST(Damage, RandomChangesNeverCrash) {
  const std::string whole = small_file();
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

// A file with Tether's header and then `rest`.
std::string file_with(const std::string& rest) {
  const TemporaryFile file;
  make_mcap_recorder(file.path())->write(header());
  return file.bytes() + rest;
}

std::string damage_of(const std::string& rest) {
  const TemporaryFile file;
  file.set_bytes(file_with(rest));
  return read(file).damage;
}

TEST(Damage, ChunksThatLieAreNamed) {
  const std::string message = raw_record(Opcode::kMessage, std::string(22, '\0'));
  EXPECT_NE(damage_of(raw_chunk(1ULL << 60, 0, "zstd", "")).find("more than a record holds"),
            std::string::npos);
  EXPECT_NE(damage_of(raw_chunk(10 << 20, 0, "zstd", "junk")).find("compressed data"),
            std::string::npos);
  EXPECT_NE(damage_of(raw_chunk(5, 0, "", "1234")).find("size is not"), std::string::npos);
  EXPECT_NE(damage_of(raw_chunk(4, 0, "lz4", "1234")).find("lz4"), std::string::npos);
  EXPECT_NE(damage_of(raw_chunk(message.size(), 1, "", message)).find("CRC mismatch of a chunk"),
            std::string::npos);
  EXPECT_NE(damage_of(raw_chunk(message.size(), 0, "", message)).find("unknown channel"),
            std::string::npos);
  const std::string inner = raw_chunk(0, 0, "", "");
  EXPECT_NE(damage_of(raw_chunk(inner.size(), 0, "", inner)).find("lies in a chunk"),
            std::string::npos);
}

TEST(Damage, PlaceIsTheRecordsOffset) {
  const std::string front = file_with("");
  EXPECT_NE(damage_of(raw_chunk(4, 0, "lz4", "1234"))
                .find("at byte " + std::to_string(front.size()) + ":"),
            std::string::npos);
}

/// A message of sequence 42 that is no ground truth, under that topic.
std::string wrong_message(const std::string& topic) {
  std::string content;
  append_u16(content, 1);
  append_string(content, "tether.GroundTruth");
  append_string(content, "");
  append_string(content, "");
  std::string records = raw_record(Opcode::kSchema, content);
  content.clear();
  append_u16(content, 7);
  append_u16(content, 1);
  append_string(content, topic);
  append_string(content, "json");
  append_u32(content, 0);
  records += raw_record(Opcode::kChannel, content);
  content.clear();
  append_u16(content, 7);
  append_u32(content, 42);
  append_u64(content, 0);
  append_u64(content, 0);
  return records + raw_record(Opcode::kMessage, content + "{\"uav\":3}");
}

TEST(Damage, MessageThatIsNoJsonIsNamedWithItsTopic) {
  const std::string damage = damage_of(wrong_message("/ground_truth/a"));
  EXPECT_NE(damage.find("message 42 of /ground_truth/a"), std::string::npos) << damage;
  EXPECT_NE(damage.find("\"uav\""), std::string::npos) << damage;
}

TEST(Damage, IsToldInOnePrintableLineWhateverTheFileHolds) {
  const std::string damage = damage_of(wrong_message("/a\nb\x1b[2J"));
  EXPECT_NE(damage.find("message 42 of /a?b?[2J"), std::string::npos) << damage;
}

}  // namespace
}  // namespace tether::record
