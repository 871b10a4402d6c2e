#include "crc.h"

#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <tether/mavlink/frame.h>

namespace tether::mavlink {
namespace {

std::vector<std::uint8_t> heartbeat(std::uint8_t sequence = 0) {
  return encode(Message("HEARTBEAT").set("type", 2).set("custom_mode", 7), {1, 1}, sequence);
}

// The frame that other implementations make: checked with their decoders.
TEST(Frame, OfAHeartbeatHasTheKnownBytes) {
  const std::vector<std::uint8_t> expected = {0xFD, 9, 0, 0, 5, 1,  1,  0, 0, 0,
                                              7,    0, 0, 0, 2, 12, 81, 4, 3};
  const auto bytes = encode(Message("HEARTBEAT")
                                .set("custom_mode", 7)
                                .set("type", 2)
                                .set("autopilot", 12)
                                .set("base_mode", 81)
                                .set("system_status", 4)
                                .set("mavlink_version", 3),
                            {1, 1}, 5);
  ASSERT_EQ(bytes.size(), expected.size() + 2);
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), bytes.begin()));
}

// Random values of every message, with zeros at the end that the frame leaves out.
TEST(Frame, EveryMessageComesBack) {
  std::mt19937 random(7);
  for (const MessageType& type : message_types()) {
    for (int round = 0; round < 20; ++round) {
      std::vector<std::uint8_t> payload(type.length);
      for (std::size_t i = 0; i < payload.size() * static_cast<std::size_t>(round) / 19; ++i)
        payload[i] = static_cast<std::uint8_t>(random());
      Message message(type);
      message.set_payload(payload);
      Decoder decoder;
      const auto frames = decoder.push(encode(message, {9, 200}, 77));
      ASSERT_EQ(frames.size(), 1U) << type.name;
      EXPECT_TRUE(std::ranges::equal(frames[0].message.payload(), payload)) << type.name;
      EXPECT_EQ(frames[0].from, (Address{9, 200}));
      EXPECT_EQ(frames[0].sequence, 77);
      EXPECT_EQ(&frames[0].message.type(), &type);
    }
  }
}

TEST(Decoder, FindsFramesInAnyPiecesAndBetweenGarbage) {
  std::mt19937 random(3);
  std::vector<std::uint8_t> stream;
  for (std::uint8_t i = 0; i < 100; ++i) {
    const auto frame = heartbeat(i);
    stream.insert(stream.end(), frame.begin(), frame.end());
    for (unsigned garbage = random() % 4; garbage > 0; --garbage)
      stream.push_back(static_cast<std::uint8_t>(random() % 0xF0));
  }
  Decoder decoder;
  std::vector<std::uint8_t> sequences;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t piece = std::min<std::size_t>(1 + random() % 40, stream.size() - at);
    for (const Frame& frame : decoder.push(std::span(stream).subspan(at, piece)))
      sequences.push_back(frame.sequence);
    at += piece;
  }
  ASSERT_EQ(sequences.size(), 100U);
  for (std::uint8_t i = 0; i < 100; ++i) EXPECT_EQ(sequences[i], i);
  EXPECT_GT(decoder.counts().skipped_bytes, 0U);
}

TEST(Decoder, AChangedByteIsNoFrameAndHidesNone) {
  const auto good = heartbeat(1);
  for (std::size_t i = 0; i < good.size(); ++i) {
    auto stream = good;
    stream[i] ^= 0x10U;
    // Enough bytes behind it that a wrong length does not wait for more.
    for (std::uint8_t k = 2; k < 30; ++k) {
      const auto next = heartbeat(k);
      stream.insert(stream.end(), next.begin(), next.end());
    }
    Decoder decoder;
    std::size_t later = 0;
    for (const Frame& frame : decoder.push(stream)) {
      EXPECT_NE(frame.sequence, i == 4 ? 0 : 1) << "byte " << i;
      later += frame.sequence > 1 ? 1U : 0U;
    }
    EXPECT_GE(later, 10U) << "byte " << i;
  }
}

TEST(Decoder, ReadsMavlink1) {
  // A HEARTBEAT of MAVLink 1: magic, length, sequence, system, component, id, payload, checksum.
  std::vector<std::uint8_t> bytes = {0xFE, 9, 4, 3, 190, 0, 7, 0, 0, 0, 2, 12, 81, 4, 3};
  std::uint16_t crc = 0xFFFF;
  const auto add = [&crc](std::uint8_t byte) {
    auto t = static_cast<std::uint8_t>(byte ^ (crc & 0xFFU));
    t = static_cast<std::uint8_t>(t ^ (t << 4U));
    crc = static_cast<std::uint16_t>((crc >> 8U) ^ (t << 8U) ^ (t << 3U) ^ (t >> 4U));
  };
  for (std::size_t i = 1; i < bytes.size(); ++i) add(bytes[i]);
  add(50);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  Decoder decoder;
  const auto frames = decoder.push(bytes);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].version, 1);
  EXPECT_EQ(frames[0].from, (Address{3, 190}));
  EXPECT_EQ(frames[0].message.integer("custom_mode"), 7);
}

TEST(Decoder, CountsWhatItDoesNotTake) {
  Decoder decoder;
  auto unknown = heartbeat();
  unknown[7] = 0xEE;
  unknown[8] = 0xEE;
  EXPECT_TRUE(decoder.push(unknown).empty());
  auto flags = heartbeat();
  flags[2] = 0x80;
  EXPECT_TRUE(decoder.push(flags).empty());
  EXPECT_EQ(decoder.counts().unknown, 1U);  // known when the next frame begins
  EXPECT_EQ(decoder.counts().incompatible, 1U);
  EXPECT_EQ(decoder.push(heartbeat(8)).size(), 1U);
  auto damaged = heartbeat();
  damaged[12] ^= 1U;
  EXPECT_TRUE(decoder.push(damaged).empty());
  EXPECT_EQ(decoder.counts().wrong_checksums, 1U);
  EXPECT_EQ(decoder.push(heartbeat(9)).size(), 1U);
}

// Garbage that looks like the beginning of a frame of a message that nobody knows.
TEST(Decoder, GarbageHidesNoFrameThatDoesNotBeginWhereItSeemsToEnd) {
  const std::size_t size = heartbeat().size();
  for (unsigned length = 0; length < 256; ++length) {
    std::vector<std::uint8_t> stream = {
        0xFD, static_cast<std::uint8_t>(length), 0, 0, 0, 0, 0, 0xEE, 0xEE, 0xEE};
    if ((length + 2) % size == 0) continue;
    for (std::uint8_t i = 0; i < 20; ++i) {
      const auto frame = heartbeat(i);
      stream.insert(stream.end(), frame.begin(), frame.end());
    }
    Decoder decoder;
    EXPECT_EQ(decoder.push(stream).size(), 20U) << length;
    EXPECT_EQ(decoder.counts().skipped_bytes, 10U) << length;
    // Whatever the pieces.
    Decoder in_bytes;
    std::size_t frames = 0;
    for (const std::uint8_t& byte : stream) frames += in_bytes.push({&byte, 1}).size();
    EXPECT_EQ(frames, 20U) << length;
  }
}

TEST(Decoder, CountsAnUnknownMessageOfADatagram) {
  Decoder decoder;
  auto unknown = heartbeat();
  unknown[9] = 0xEE;
  EXPECT_TRUE(decoder.push_datagram(unknown).empty());
  EXPECT_EQ(decoder.counts().unknown, 1U);
  EXPECT_EQ(decoder.counts().skipped_bytes, unknown.size());
}

TEST(Decoder, AHalfFrameOfAStreamIsCompletedByTheNextBytes) {
  const auto frame = heartbeat(5);
  for (std::size_t half = 0; half < frame.size(); ++half) {
    Decoder decoder;
    EXPECT_TRUE(decoder.push(std::span(frame).first(half)).empty());
    EXPECT_EQ(decoder.push(std::span(frame).subspan(half)).size(), 1U) << half;
    EXPECT_EQ(decoder.counts().skipped_bytes, 0U);
  }
}

TEST(Decoder, AHalfFrameOfADatagramDelaysNoOther) {
  const auto frame = heartbeat(5);
  const auto text = encode(Message("STATUSTEXT").set_text("text", std::string(50, 'x')), {1, 1}, 0);
  Decoder decoder;
  for (std::size_t half = 1; half < frame.size(); ++half) {
    EXPECT_TRUE(decoder.push_datagram(std::span(frame).first(half)).empty());
    EXPECT_EQ(decoder.push_datagram(frame).size(), 1U) << half;
    // Nor one behind it in the same datagram.
    std::vector<std::uint8_t> both(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(half));
    both.insert(both.end(), frame.begin(), frame.end());
    EXPECT_EQ(decoder.push_datagram(both).size(), 1U) << half;
  }
}

// A newer peer may have extensions that the table lacks: they are ignored. An older one has none.
TEST(Decoder, TakesPayloadsOfOtherLengths) {
  Message message("HEARTBEAT");
  message.set("type", 2);
  const auto longer = [](const Message& m, std::size_t length) {
    auto bytes = encode(m, {1, 1}, 0);
    bytes.resize(10);
    const auto payload = m.payload();
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    bytes.resize(10 + length, 0xAB);
    bytes[1] = static_cast<std::uint8_t>(length);
    Crc crc;
    crc.add(std::span(bytes).subspan(1));
    crc.add(m.type().crc_extra);
    bytes.push_back(static_cast<std::uint8_t>(crc.value() & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(crc.value() >> 8U));
    return bytes;
  };
  Decoder decoder;
  for (const std::size_t length : {0U, 5U, 9U, 12U, 255U}) {
    const auto frames = decoder.push(longer(message, length));
    ASSERT_EQ(frames.size(), 1U) << length;
    EXPECT_EQ(frames[0].message.payload().size(), 9U);
    EXPECT_EQ(frames[0].message.integer("type"), length > 4 ? 2 : 0) << length;
  }
}

TEST(Decoder, RandomBytesAreNoFrames) {
  std::mt19937 random(11);
  Decoder decoder;
  std::size_t frames = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> piece(1 + random() % 100);
    for (auto& byte : piece) byte = random() % 8 == 0 ? 0xFD : static_cast<std::uint8_t>(random());
    frames += decoder.push(piece).size();
  }
  EXPECT_LE(frames, 1U);  // one in 65,536 has the right checksum
  // It has not lost its way: at most the longest frame is awaited.
  std::size_t later = 0;
  for (std::uint8_t i = 0; i < 40; ++i) later += decoder.push(heartbeat(i)).size();
  EXPECT_GE(later, 20U);
}

}  // namespace
}  // namespace tether::mavlink
