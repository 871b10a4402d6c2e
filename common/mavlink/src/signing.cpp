#include "crc.h"
#include "sha256.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <string>
#include <vector>

#include <tether/mavlink/frame.h>

namespace tether::mavlink {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// The first 48 bits of the SHA-256 of the key, the frame, the link id and the timestamp.
std::array<std::uint8_t, 6> signature_of(const SigningKey& key,
                                         std::span<const std::uint8_t> signed_part) {
  const Digest digest = Sha256().add(key).add(signed_part).finish();
  std::array<std::uint8_t, 6> signature{};
  std::copy_n(digest.begin(), signature.size(), signature.begin());
  return signature;
}

using Bytes = std::vector<std::uint8_t>;
using Verdict = SignatureChecker::Verdict;

constexpr std::uint8_t kSigned = 1;  // a flag
constexpr std::size_t kFlags = 2, kSystem = 5, kComponent = 6;

/// How long the frame is that begins there, if it is whole; 0: none.
std::size_t whole_frame(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kVersion1 = 0xFE, kVersion2 = 0xFD;
  constexpr std::size_t kBeside1 = 8, kBeside2 = 12;
  if (bytes.size() < kBeside1 || (bytes[0] != kVersion1 && bytes[0] != kVersion2)) return 0;
  std::size_t size = bytes[1] + kBeside1;
  if (bytes[0] == kVersion2)
    size = bytes[1] + kBeside2 + ((bytes[kFlags] & kSigned) != 0 ? kSignatureBytes : 0);
  return size <= bytes.size() ? size : 0;
}
bool is_of_version_2(std::span<const std::uint8_t> frame) {
  return frame[0] == 0xFD;
}

/// Of a frame without signature, with the flag that it has one or has none. The checksum is linear:
/// a bit that changes in a message changes it as in one of zeros, so that the message need not be
/// in the table.
Bytes with_other_flag(std::span<const std::uint8_t> frame) {
  Bytes other(frame.begin(), frame.end());
  other[kFlags] ^= kSigned;
  Crc change(0);
  change.add(kSigned);
  const std::size_t checksum = frame.size() - 2;
  for (std::size_t i = kFlags + 1; i <= checksum; ++i) change.add(std::uint8_t{0});
  other[checksum] ^= static_cast<std::uint8_t>(change.value() & 0xFFU);
  other[checksum + 1] ^= static_cast<std::uint8_t>(change.value() >> 8U);
  return other;
}

}  // namespace

SigningKey key_of_passphrase(std::string_view passphrase) {
  return Sha256().add(bytes_of(passphrase)).finish();
}

Result<SigningKey> key_of_file(std::string_view content) {
  SigningKey key{};
  if (content.size() == key.size()) {
    std::ranges::copy(bytes_of(content), key.begin());
    return key;
  }
  constexpr std::string_view kSpace = " \t\r\n";
  const auto begin = std::min(content.find_first_not_of(kSpace), content.size());
  const std::string_view digits =
      content.substr(begin, content.find_last_not_of(kSpace) + 1 - begin);
  bool right = digits.size() == 2 * key.size();
  for (std::size_t i = 0; right && i < key.size(); ++i) {
    const char* pair = digits.data() + 2 * i;
    right = std::from_chars(pair, pair + 2, key[i], 16).ptr == pair + 2;
  }
  if (right) return key;
  return invalid("a MAVLink signing key has 32 bytes or 64 hexadecimal digits; found " +
                 std::to_string(content.size()) + " bytes");
}

void Signer::advance_to(std::uint64_t timestamp) {
  next_ = std::max(next_, timestamp);
}

std::array<std::uint8_t, kSignatureBytes> Signer::sign(std::span<const std::uint8_t> frame) {
  assert(next_ <= kLastTimestamp);
  std::array<std::uint8_t, kSignatureBytes> end{link_};
  for (std::size_t i = 0; i < 6; ++i) end[1 + i] = static_cast<std::uint8_t>(next_ >> (8 * i));
  ++next_;
  std::vector<std::uint8_t> signed_part(frame.begin(), frame.end());
  signed_part.insert(signed_part.end(), end.begin(), end.begin() + 7);
  std::ranges::copy(signature_of(key_, signed_part), end.begin() + 7);
  return end;
}

Bytes SignedLink::sign(std::span<const std::uint8_t> datagram, std::uint64_t timestamp) {
  signer_.advance_to(std::max(timestamp, checker_.newest()));
  Bytes all;
  while (!datagram.empty()) {
    const std::size_t size = whole_frame(datagram);
    const auto part = datagram.first(std::max<std::size_t>(size, 1));
    datagram = datagram.subspan(part.size());
    if (size == 0 || !is_of_version_2(part) || (part[kFlags] & kSigned) != 0) {
      all.insert(all.end(), part.begin(), part.end());
      continue;
    }
    const Bytes frame = with_other_flag(part);
    const auto signature = signer_.sign(frame);
    all.insert(all.end(), frame.begin(), frame.end());
    all.insert(all.end(), signature.begin(), signature.end());
  }
  return all;
}

SignedLink::Opened SignedLink::open(std::span<const std::uint8_t> datagram) {
  Opened opened;
  while (!datagram.empty()) {
    const std::size_t size = whole_frame(datagram);
    const auto frame = datagram.first(std::max<std::size_t>(size, 1));
    datagram = datagram.subspan(frame.size());
    if (size == 0) continue;
    if (!is_of_version_2(frame) || (frame[kFlags] & kSigned) == 0) return {};
    opened.verdict = checker_.check(frame, frame[kSystem], frame[kComponent]);
    if (opened.verdict != Verdict::kRight) return {opened.verdict};
    const Bytes own = with_other_flag(frame.first(size - kSignatureBytes));
    opened.frames.insert(opened.frames.end(), own.begin(), own.end());
  }
  return opened;
}

Verdict SignatureChecker::check(std::span<const std::uint8_t> frame, std::uint8_t system,
                                std::uint8_t component) {
  assert(frame.size() > kSignatureBytes);
  const auto end = frame.last(kSignatureBytes);
  const auto expected = signature_of(key_, frame.first(frame.size() - 6));
  // In constant time.
  unsigned difference = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    difference |= static_cast<unsigned>(expected[i] ^ end[7 + i]);
  if (difference != 0) return Verdict::kWrong;

  std::uint64_t timestamp = 0;
  for (std::size_t i = 6; i >= 1; --i) timestamp = timestamp << 8 | end[i];
  const auto [last, is_new] = last_.try_emplace({end[0], system, component}, timestamp);
  const bool old = is_new ? timestamp + kTimestampsPerMinute < newest_ : timestamp <= last->second;
  if (old) {
    if (is_new) last_.erase(last);
    return Verdict::kOld;
  }
  last->second = timestamp;
  newest_ = std::max(newest_, timestamp);
  return Verdict::kRight;
}

}  // namespace tether::mavlink
