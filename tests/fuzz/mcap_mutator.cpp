#include "mcap_mutator.h"

#include <algorithm>
#include <vector>

/// libFuzzer's own mutations of a file, which it calls itself.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace tether::fuzz {
namespace {

constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kPrefixBytes = 9;  // opcode, length of what follows

std::uint64_t read_u64(const std::uint8_t* at) {
  std::uint64_t value = 0;
  for (int i = 7; i >= 0; --i) value = value << 8 | at[i];
  return value;
}
void write_u64(std::uint8_t* at, std::uint64_t value) {
  for (int i = 0; i < 8; ++i) at[i] = static_cast<std::uint8_t>(value >> 8 * i);
}

/// Where the file's records begin, as far as they are whole.
std::vector<std::size_t> record_starts(const std::uint8_t* data, std::size_t size) {
  std::vector<std::size_t> starts;
  for (std::size_t at = kMagicBytes; at + kPrefixBytes <= size;) {
    const std::uint64_t length = read_u64(data + at + 1);
    if (length > size - at - kPrefixBytes) break;
    starts.push_back(at);
    at += kPrefixBytes + static_cast<std::size_t>(length);
  }
  return starts;
}

}  // namespace

std::size_t mutate_mcap(std::uint8_t* data, std::size_t size, std::size_t max_size,
                        unsigned int seed) {
  const auto starts = record_starts(data, size);
  if (starts.empty() || seed % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::uint8_t* const record = data + starts[seed / 4 % starts.size()];
  const auto length = static_cast<std::size_t>(read_u64(record + 1));
  std::uint8_t* const content = record + kPrefixBytes;
  const std::vector<std::uint8_t> after(content + length, data + size);
  const std::size_t room = length + (max_size > size ? max_size - size : 0);
  const std::size_t mutated = LLVMFuzzerMutate(content, length, room);
  if (mutated > room) return size;
  write_u64(record + 1, mutated);
  std::copy(after.begin(), after.end(), content + mutated);
  return static_cast<std::size_t>(content - data) + mutated + after.size();
}

}  // namespace tether::fuzz
