#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/mavlink/frame.h>

namespace tether::mavlink {
namespace {

const SigningKey kKey = key_of_passphrase("a secret");
constexpr std::uint64_t kNow = 0x1234'5678'9ABC;

std::vector<std::uint8_t> signed_ping(Signer& signer, Address from = {1, 1}) {
  return encode(Message("PING").set("seq", 5), from, 9, &signer);
}

TEST(SigningKey, OfAPassphraseIsItsSha256) {
  const SigningKey key = key_of_passphrase("abc");
  EXPECT_EQ(key[0], 0xBA);
  EXPECT_EQ(key[31], 0xAD);
}

TEST(SigningKey, OfAFileIsItsBytesOrItsHexadecimalDigits) {
  std::string bytes(32, '\0'), digits;
  for (std::size_t i = 0; i < 32; ++i) {
    bytes[i] = static_cast<char>(i * 7);
    digits += "0123456789abcdef"[i * 7 % 256 / 16];
    digits += "0123456789ABCDEF"[i * 7 % 16];
  }
  const auto key = key_of_file(bytes);
  ASSERT_TRUE(key.ok());
  EXPECT_EQ((*key)[31], 31 * 7);
  for (const std::string& text : {digits, digits + "\n", " \t" + digits + "\r\n"}) {
    ASSERT_TRUE(key_of_file(text).ok()) << text;
    EXPECT_EQ(*key_of_file(text), *key) << text;
  }
}

TEST(SigningKey, RefusesOtherFiles) {
  for (const std::string& text :
       {std::string(), std::string("\n\n"), std::string(31, 'a'), std::string(33, 'a'),
        std::string(63, 'a'), std::string(65, 'a'), std::string(63, 'a') + "g",
        std::string(62, 'a') + "-1", std::string(62, 'a') + "0x"}) {
    const auto key = key_of_file(text);
    ASSERT_FALSE(key.ok()) << text;
    EXPECT_EQ(key.failure().kind, Failure::Kind::kInvalid);
    EXPECT_NE(key.failure().message.find(std::to_string(text.size()) + " bytes"), text.npos);
  }
}

TEST(Signer, FramesHaveTheFlagTheLinkAndTheTimestamp) {
  Signer signer(kKey, 3, kNow);
  const auto bytes = signed_ping(signer);
  Signer again(kKey, 3, kNow);
  EXPECT_EQ(bytes, signed_ping(again));
  EXPECT_EQ(bytes[2], 1);  // the flag of signed frames, which the checksum covers
  const auto end = std::span(bytes).last(kSignatureBytes);
  const std::uint8_t expected[] = {3, 0xBC, 0x9A, 0x78, 0x56, 0x34, 0x12};
  EXPECT_TRUE(std::ranges::equal(end.first(7), expected));
}

// A frame that node-mavlink 2.3.0 signed with this passphrase.
TEST(Signer, MakesTheSameFrameAsAnotherImplementation) {
  const std::vector<std::uint8_t> expected = {0xFD, 0x09, 0x01, 0x00, 0x05, 0x01, 0x01, 0x00, 0x00,
                                              0x00, 0x07, 0x00, 0x00, 0x00, 0x02, 0x0C, 0x51, 0x04,
                                              0x03, 0x7B, 0xEE, 0x03, 0x00, 0xE0, 0x3C, 0xD6, 0x92,
                                              0x1F, 0x4D, 0x6F, 0x0F, 0xD7, 0xB9, 0x35};
  Signer signer(kKey, 3, 34'715'520'000'000);
  Message heartbeat("HEARTBEAT");
  heartbeat.set("custom_mode", 7).set("type", 2).set("autopilot", 12).set("base_mode", 81);
  heartbeat.set("system_status", 4).set("mavlink_version", 3);
  EXPECT_EQ(encode(heartbeat, {1, 1}, 5, &signer), expected);
  EXPECT_EQ(Decoder(&kKey).push(expected).size(), 1U);
}

TEST(Signer, TimestampsIncrease) {
  Signer signer(kKey, 0, 100);
  const auto low_byte = [&] { return *(signed_ping(signer).end() - 12); };
  EXPECT_EQ(low_byte(), 100);
  EXPECT_EQ(low_byte(), 101);
  signer.advance_to(50);
  EXPECT_EQ(low_byte(), 102);
  signer.advance_to(200);
  EXPECT_EQ(low_byte(), 200);
}

TEST(SignedDecoder, TakesFramesOfTheSameKeyOnly) {
  const SigningKey other_key = key_of_passphrase("another secret");
  Signer signer(kKey, 0, kNow), other(other_key, 0, kNow);
  Decoder decoder(&kKey);
  EXPECT_TRUE(decoder.push(signed_ping(other)).empty());
  EXPECT_EQ(decoder.counts().wrong_signatures, 1U);
  const auto frames = decoder.push(signed_ping(signer));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].is_signed);
  EXPECT_EQ(frames[0].message.integer("seq"), 5);
  // Without a key, signatures are not looked at.
  EXPECT_EQ(Decoder().push(signed_ping(other)).size(), 1U);
}

TEST(SignedDecoder, RefusesEachChangedBitOfASignature) {
  Signer signer(kKey, 0, kNow);
  const auto bytes = signed_ping(signer);
  for (std::size_t bit = 0; bit < 8 * kSignatureBytes; ++bit) {
    auto changed = bytes;
    changed[bytes.size() - 1 - bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    Decoder decoder(&kKey);
    EXPECT_TRUE(decoder.push(changed).empty()) << bit;
    EXPECT_EQ(decoder.counts().wrong_signatures, 1U) << bit;
    // What was refused changes nothing.
    EXPECT_EQ(decoder.push(bytes).size(), 1U) << bit;
  }
}

TEST(SignedDecoder, RefusesWhatIsNotSigned) {
  Decoder decoder(&kKey);
  EXPECT_TRUE(decoder.push(encode(Message("PING"), {1, 1}, 0)).empty());
  EXPECT_EQ(decoder.counts().not_signed, 1U);
}

TEST(SignedDecoder, RefusesAFrameThatIsReplayed) {
  Signer signer(kKey, 0, kNow);
  const auto first = signed_ping(signer);
  const auto second = signed_ping(signer);
  Decoder decoder(&kKey);
  EXPECT_EQ(decoder.push(first).size(), 1U);
  EXPECT_TRUE(decoder.push(first).empty());
  EXPECT_EQ(decoder.push(second).size(), 1U);
  EXPECT_TRUE(decoder.push(first).empty());
  EXPECT_EQ(decoder.counts().old_signatures, 2U);
}

// Each (link, system, component) has its own timestamps, and one that is new is not far behind.
TEST(SignedDecoder, ComparesTimestampsOfOneStreamOnly) {
  Decoder decoder(&kKey);
  Signer signer(kKey, 0, kNow);
  EXPECT_EQ(decoder.push(signed_ping(signer)).size(), 1U);
  for (const auto& [link, from] :
       {std::pair<std::uint8_t, Address>{1, {1, 1}}, {0, {2, 1}}, {0, {1, 2}}}) {
    Signer late(kKey, link, kNow - kTimestampsPerMinute - 2);
    EXPECT_TRUE(decoder.push(signed_ping(late, from)).empty());
    EXPECT_TRUE(decoder.push(signed_ping(late, from)).empty());
    EXPECT_EQ(decoder.push(signed_ping(late, from)).size(), 1U);
  }
}

TEST(SignedDecoder, FindsFramesInAnyPiecesAndBetweenGarbage) {
  Signer signer(kKey, 0, kNow);
  std::vector<std::uint8_t> stream;
  for (std::uint8_t i = 0; i < 20; ++i) {
    stream.insert(stream.end(), i % 4, std::uint8_t(0x7F + i));
    const auto frame = signed_ping(signer);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  Decoder whole(&kKey), pieces(&kKey);
  EXPECT_EQ(whole.push(stream).size(), 20U);
  std::size_t frames = 0;
  for (const std::uint8_t byte : stream) frames += pieces.push({&byte, 1}).size();
  EXPECT_EQ(frames, 20U);
}

// One of ours, and one of a message that is not in the table.
std::vector<std::uint8_t> unsigned_datagram() {
  auto datagram = encode(Message("PING").set("seq", 5), {1, 191}, 9);
  const std::array<std::uint8_t, 15> unknown = {0xFD, 3, 0, 0, 7, 1,    191, 0xFE,
                                                0xFF, 0, 1, 2, 3, 0x12, 0x34};
  datagram.insert(datagram.end(), unknown.begin(), unknown.end());
  return datagram;
}

TEST(SignedLink, SignsFramesOfAnyMessageAndTakesSignaturesOff) {
  SignedLink here(kKey, 1, kNow), there(kKey, 2, kNow);
  const auto datagram = unsigned_datagram();
  const auto bytes = here.sign(datagram, kNow + 7);
  EXPECT_EQ(bytes.size(), datagram.size() + 2 * kSignatureBytes);
  EXPECT_EQ(Decoder(&kKey).push_datagram(bytes).size(), 1U) << "as others read it";
  const auto opened = there.open(bytes);
  EXPECT_EQ(opened.verdict, SignatureChecker::Verdict::kRight);
  EXPECT_EQ(opened.frames, datagram);
  EXPECT_EQ(here.sign({}, kNow), std::vector<std::uint8_t>());
}

TEST(SignedLink, RefusesWhatIsNotSignedOrWronglyOrComesAgain) {
  using enum SignatureChecker::Verdict;
  SignedLink other(key_of_passphrase("another"), 1, kNow), sender(kKey, 1, kNow);
  SignedLink late(kKey, 1, kNow - kTimestampsPerMinute - 100), there(kKey, 2, kNow);
  const auto datagram = unsigned_datagram();
  EXPECT_EQ(there.open({}).verdict, kNotSigned);
  EXPECT_EQ(there.open(datagram).verdict, kNotSigned);
  EXPECT_EQ(there.open(other.sign(datagram, 0)).verdict, kWrong);
  EXPECT_EQ(there.open(late.sign(datagram, 0)).verdict, kOld) << "recorded before it began";
  const auto bytes = sender.sign(datagram, 0);
  EXPECT_EQ(there.open(bytes).verdict, kRight);
  const auto again = there.open(bytes);
  EXPECT_EQ(again.verdict, kOld);
  EXPECT_TRUE(again.frames.empty());
  auto mixed = sender.sign(datagram, 0);
  mixed.insert(mixed.end(), datagram.begin(), datagram.end());
  EXPECT_EQ(there.open(mixed).verdict, kNotSigned) << "as a whole";
  const std::vector<std::uint8_t> old_version = {0xFE, 0, 1, 1, 1, 0, 0, 0};
  EXPECT_EQ(there.open(old_version).verdict, kNotSigned);
  EXPECT_EQ(there.open(sender.sign(datagram, 0)).verdict, kRight) << "and goes on";
}

// The clock of a controller may be behind.
TEST(SignedLink, TakesTheTimeOfTheOtherEnd) {
  SignedLink ahead(kKey, 1, kNow + 100 * kTimestampsPerMinute), behind(kKey, 2, kNow);
  EXPECT_EQ(behind.open(ahead.sign(unsigned_datagram(), 0)).verdict,
            SignatureChecker::Verdict::kRight);
  EXPECT_EQ(ahead.open(behind.sign(unsigned_datagram(), kNow)).verdict,
            SignatureChecker::Verdict::kRight);
}

// Whatever others send, an honest end is heard.
TEST(SignedLink, HonestFramesAreTakenBetweenAnyBytes) {
  KeyedRandom random({.seed = 41});
  SignedLink honest(kKey, 1, kNow), there(kKey, 2, kNow);
  for (int i = 0; i < 2'000; ++i) {
    std::vector<std::uint8_t> bytes(random.bits() % 300);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    if (random.bits() % 2 == 0) {
      bytes = honest.sign(unsigned_datagram(), 0);
      bytes[random.bits() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random.bits() % 8);
    }
    ASSERT_NE(there.open(bytes).frames, unsigned_datagram()) << i;
    ASSERT_EQ(there.open(honest.sign(unsigned_datagram(), 0)).verdict,
              SignatureChecker::Verdict::kRight)
        << i;
  }
}

}  // namespace
}  // namespace tether::mavlink
