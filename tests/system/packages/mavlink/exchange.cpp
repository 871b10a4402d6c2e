// Tether's side of the exchange with another implementation of MAVLink (check_mavlink.sh):
//
//   tether_mavlink_exchange write FRAMES [PASSPHRASE]   messages of every type, some with zeros at
//                                                       the end; one line for each to stdout
//   tether_mavlink_exchange read FRAMES [PASSPHRASE]    the same line for each frame of a file
//
// With a passphrase, frames are signed, and only signed ones are read. Exit 1 if a file has
// anything but frames.

#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/random.h>
#include <tether/mavlink/frame.h>

namespace {

using namespace tether;
using namespace tether::mavlink;

constexpr std::size_t kVariants = 6;

bool is_integer(const Field& field) {
  return field.type != Type::kFloat && field.type != Type::kDouble;
}

// The value of a field exactly: integers in decimal, texts in quotes, floats as their bits.
std::string text_of(const Message& message, const Field& field, std::size_t i) {
  if (field.type == Type::kFloat) {
    const auto bits =
        std::bit_cast<std::uint32_t>(static_cast<float>(message.number(field.name, i)));
    char text[9];
    std::snprintf(text, sizeof text, "%08x", bits);
    return text;
  }
  const std::int64_t value = message.integer(field.name, i);
  return field.type == Type::kUint64 ? std::to_string(static_cast<std::uint64_t>(value))
                                     : std::to_string(value);
}

void print(const Frame& frame) {
  const MessageType& type = frame.message.type();
  std::cout << type.id << ' ' << type.name << " crc_extra=" << int{type.crc_extra}
            << " length=" << type.length << " version=" << frame.version
            << " from=" << int{frame.from.system} << '.' << int{frame.from.component}
            << " sequence=" << int{frame.sequence} << " signed=" << frame.is_signed;
  for (const Field& field : type.fields) {
    std::cout << ' ' << field.name << (field.is_extension ? "(extension)=" : "=");
    if (field.type == Type::kChar && field.is_array) {
      std::cout << '"' << frame.message.text(field.name) << '"';
      continue;
    }
    for (std::size_t i = 0; i < field.count; ++i)
      std::cout << (i == 0 ? "" : ",") << text_of(frame.message, field, i);
  }
  std::cout << '\n';
}

// Variant 0 is all zeros, 1 and 2 the limits of each type; the others are random, the last ones
// with zeros from some field on.
void fill(Message& message, const Field& field, std::size_t variant, KeyedRandom& random) {
  if (field.type == Type::kChar && field.is_array) {
    std::string text;
    for (std::size_t i = random.bits() % (field.count + 1); variant != 0 && i > 0; --i)
      text += static_cast<char>('!' + random.bits() % 90);
    message.set_text(field.name, text);
    return;
  }
  for (std::size_t i = 0; i < field.count; ++i) {
    const std::uint64_t word = std::uint64_t{random.bits()} << 32U | random.bits();
    const double number = std::ldexp(random.normal(), static_cast<int>(word % 200) - 100);
    if (variant == 0) continue;
    if (variant == 1 || variant == 2) {
      const double limit = std::numeric_limits<float>::max();
      if (!is_integer(field))
        message.set(field.name, variant == 1 ? limit : -limit, i);
      else if (variant == 1)
        message.set(field.name, std::numeric_limits<std::uint64_t>::max(), i);
      else
        message.set(field.name, std::numeric_limits<std::int64_t>::min(), i);
    } else if (!is_integer(field)) {
      message.set(field.name, number, i);
    } else if (field.type == Type::kUint64) {
      message.set(field.name, word, i);
    } else {
      const auto bits = 8 * size_of(field.type);
      message.set(field.name, static_cast<std::int64_t>(word) >> (64 - bits), i);
    }
  }
}

int write(const char* file, Signer* signer) {
  std::ofstream out(file, std::ios::binary);
  std::uint8_t sequence = 0;
  for (const MessageType& type : message_types()) {
    for (std::size_t variant = 0; variant < kVariants; ++variant) {
      KeyedRandom random({1, type.id, variant});
      Frame frame{.from = {static_cast<std::uint8_t>(1 + random.bits() % 255),
                           static_cast<std::uint8_t>(random.bits())},
                  .sequence = sequence++,
                  .is_signed = signer != nullptr,
                  .message = Message(type)};
      std::size_t filled = type.fields.size();
      if (variant > 3) filled = random.bits() % type.fields.size();
      for (std::size_t i = 0; i < filled; ++i) fill(frame.message, type.fields[i], variant, random);
      const auto bytes = encode(frame.message, frame.from, frame.sequence, signer);
      out.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
      print(frame);
    }
  }
  return out.flush() ? 0 : 2;
}

int read(const char* file, const SigningKey* key) {
  std::ifstream in(file, std::ios::binary);
  const std::string content(std::istreambuf_iterator<char>(in), {});
  const std::vector<std::uint8_t> bytes(content.begin(), content.end());
  Decoder decoder(key);
  for (const Frame& frame : decoder.push(bytes)) print(frame);
  std::cerr << "skipped bytes: " << decoder.counts().skipped_bytes << '\n';
  return decoder.counts().skipped_bytes == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  std::optional<SigningKey> key;
  if (argc > 3) key = key_of_passphrase(argv[3]);
  if (what == "read") return read(argv[2], key ? &*key : nullptr);
  if (what != "write") return 2;
  // 2026-01-01.
  std::optional<Signer> signer;
  if (key) signer.emplace(*key, std::uint8_t{7}, 34'715'520'000'000U);
  return write(argv[2], signer ? &*signer : nullptr);
}
