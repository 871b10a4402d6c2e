#include "crc.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <tether/mavlink/frame.h>

namespace tether::mavlink {
namespace {

constexpr std::uint8_t kMagic1 = 0xFE, kMagic2 = 0xFD;
constexpr std::size_t kHeader1 = 6, kHeader2 = 10, kChecksum = 2;
constexpr std::uint8_t kIsSigned = 1;

std::uint16_t checksum(std::span<const std::uint8_t> without_magic, std::uint8_t crc_extra) {
  Crc crc;
  crc.add(without_magic);
  crc.add(crc_extra);
  return crc.value();
}

}  // namespace

std::vector<std::uint8_t> encode(const Message& message, Address from, std::uint8_t sequence,
                                 Signer* signer) {
  const auto payload = message.payload();
  std::size_t length = payload.size();
  while (length > 1 && payload[length - 1] == 0) --length;
  const std::uint32_t id = message.type().id;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kHeader2 + length + kChecksum + (signer == nullptr ? 0 : kSignatureBytes));
  bytes.assign({kMagic2, static_cast<std::uint8_t>(length),
                signer == nullptr ? std::uint8_t{0} : kIsSigned, 0, sequence, from.system,
                from.component, static_cast<std::uint8_t>(id & 0xFFU),
                static_cast<std::uint8_t>(id >> 8U & 0xFFU), static_cast<std::uint8_t>(id >> 16U)});
  bytes.insert(bytes.end(), payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(length));
  const std::uint16_t crc = checksum(std::span(bytes).subspan(1), message.type().crc_extra);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  if (signer != nullptr) {
    const auto signature = signer->sign(bytes);
    bytes.insert(bytes.end(), signature.begin(), signature.end());
  }
  return bytes;
}

std::vector<Frame> Decoder::push(std::span<const std::uint8_t> bytes) {
  rest_.insert(rest_.end(), bytes.begin(), bytes.end());
  return take_all(true);
}

std::vector<Frame> Decoder::push_datagram(std::span<const std::uint8_t> bytes) {
  rest_.assign(bytes.begin(), bytes.end());
  return take_all(false);
}

std::vector<Frame> Decoder::take_all(bool waits) {
  std::vector<Frame> frames;
  std::span<const std::uint8_t> left = rest_;
  while (!left.empty()) {
    std::size_t used = 1;
    const Outcome outcome = take(left, waits, used, frames);
    if (outcome == Outcome::kWait && waits) break;
    if (outcome != Outcome::kFrame) counts_.skipped_bytes += used;
    left = left.subspan(used);
  }
  rest_.erase(rest_.begin(), rest_.end() - static_cast<std::ptrdiff_t>(left.size()));
  return frames;
}

// What begins at the first byte. A frame whose checksum is wrong may be no frame, so only its first
// byte is skipped. Of a message that is not in the table, the checksum cannot be known: it is one
// if another frame begins where it ends, or its datagram ends there too.
Decoder::Outcome Decoder::take(std::span<const std::uint8_t> bytes, bool waits, std::size_t& used,
                               std::vector<Frame>& frames) {
  const bool is_2 = bytes[0] == kMagic2;
  if (!is_2 && bytes[0] != kMagic1) return Outcome::kSkip;
  const std::size_t header = is_2 ? kHeader2 : kHeader1;
  if (bytes.size() < header) return Outcome::kWait;
  const std::size_t length = bytes[1];
  const bool is_signed = is_2 && (bytes[2] & kIsSigned) != 0;
  if (is_2 && (bytes[2] & ~kIsSigned) != 0) {
    ++counts_.incompatible;
    return Outcome::kSkip;
  }
  const std::size_t whole = header + length + kChecksum + (is_signed ? kSignatureBytes : 0);
  if (bytes.size() < whole) return Outcome::kWait;
  const std::uint32_t id =
      is_2 ? bytes[7] | std::uint32_t{bytes[8]} << 8U | std::uint32_t{bytes[9]} << 16U : bytes[5];
  const MessageType* type = find_type(id);
  if (type == nullptr) {
    const bool ends = bytes.size() == whole;
    if (ends && waits) return Outcome::kWait;
    if (!ends && bytes[whole] != kMagic1 && bytes[whole] != kMagic2) return Outcome::kSkip;
    ++counts_.unknown;
    used = whole;
    return Outcome::kSkip;
  }
  const std::size_t end = header + length;
  const std::uint16_t crc = checksum(bytes.subspan(1, end - 1), type->crc_extra);
  if (bytes[end] != (crc & 0xFFU) || bytes[end + 1] != crc >> 8U) {
    ++counts_.wrong_checksums;
    return Outcome::kSkip;
  }
  const std::size_t at = is_2 ? 4 : 2;
  Frame frame{.from = {bytes[at + 1], bytes[at + 2]},
              .sequence = bytes[at],
              .version = is_2 ? 2 : 1,
              .is_signed = is_signed,
              .message = Message(*type)};
  used = whole;
  if (!is_authentic(bytes.first(whole), frame)) return Outcome::kSkip;
  frame.message.set_payload(bytes.subspan(header, length));
  frames.push_back(frame);
  return Outcome::kFrame;
}

bool Decoder::is_authentic(std::span<const std::uint8_t> bytes, const Frame& frame) {
  if (!checker_) return true;
  if (!frame.is_signed) {
    ++counts_.not_signed;
    return false;
  }
  using Verdict = SignatureChecker::Verdict;
  const Verdict verdict = checker_->check(bytes, frame.from.system, frame.from.component);
  if (verdict == Verdict::kWrong) ++counts_.wrong_signatures;
  if (verdict == Verdict::kOld) ++counts_.old_signatures;
  return verdict == Verdict::kRight;
}

}  // namespace tether::mavlink
