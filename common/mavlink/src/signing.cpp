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

SignatureChecker::Verdict SignatureChecker::check(std::span<const std::uint8_t> frame,
                                                  std::uint8_t system, std::uint8_t component) {
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
