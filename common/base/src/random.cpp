#include <cmath>
#include <numbers>

#include <tether/base/random.h>

namespace tether {

namespace {

constexpr std::uint64_t kFnvOffset = 0xcbf29ce484222325u;
constexpr std::uint64_t kFnvPrime = 0x100000001b3u;

std::uint64_t fnv1a(std::uint64_t hash, std::string_view text) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * kFnvPrime;
  // A byte that no UTF-8 text contains ends each name, so that ("ab", "c") and ("a", "bc") differ.
  return (hash ^ 0xffu) * kFnvPrime;
}

constexpr std::uint32_t high(std::uint64_t v) {
  return static_cast<std::uint32_t>(v >> 32);
}
constexpr std::uint32_t low(std::uint64_t v) {
  return static_cast<std::uint32_t>(v);
}

}  // namespace

std::uint64_t random_stream(std::string_view uav, std::string_view sensor,
                            std::string_view quantity) {
  return fnv1a(fnv1a(fnv1a(kFnvOffset, uav), sensor), quantity);
}

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {high(p1) ^ counter[1] ^ key[0], low(p1), high(p0) ^ counter[3] ^ key[1], low(p0)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

// Seed and stream (128 bits) are hashed by the generator itself into its key and one counter word;
// the index takes two counter words, the number of the block within the sequence the last.
KeyedRandom::KeyedRandom(const RandomKey& key) : counter_{low(key.index), high(key.index), 0, 0} {
  const auto mixed = philox4x32({low(key.stream), high(key.stream), low(key.seed), high(key.seed)},
                                {0x54455448u, 0x45523031u});
  key_ = {mixed[0], mixed[1]};
  counter_[3] = mixed[2];
}

std::uint32_t KeyedRandom::bits() {
  if (used_ == 4) {
    block_ = philox4x32(counter_, key_);
    ++counter_[2];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double KeyedRandom::uniform() {
  const std::uint64_t a = bits() >> 5;
  const std::uint64_t b = bits() >> 6;
  return static_cast<double>(a * 67108864u + b) * (1.0 / 9007199254740992.0);
}

double KeyedRandom::normal() {
  const double u = 1.0 - uniform();  // (0, 1]: the logarithm is finite
  const double v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

}  // namespace tether
