#include "kernels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

// Each loop has several independent chains, as most programs have, and leaves a result that the
// compiler must compute.
namespace tether::calibration {
namespace {

constexpr std::size_t kSize = 4096;

volatile std::uint64_t g_result = 1;
volatile double g_real = 1.5;

struct Data {
  std::array<std::uint8_t, kSize> bytes{}, others{};
  std::array<std::uint32_t, kSize> words{};
  std::array<float, kSize> reals{}, sums{};
  std::array<std::uint64_t, 64> sorted{};
};

Data& data() {
  static Data made = [] {
    Data d;
    std::uint32_t state = 12345;
    for (std::size_t i = 0; i < kSize; ++i) {
      state = state * 1664525u + 1013904223u;
      d.bytes[i] = static_cast<std::uint8_t>(state >> 24);
      d.others[i] = static_cast<std::uint8_t>(state >> 16);
      d.words[i] = state;
      d.reals[i] = static_cast<float>(state >> 8) * 1e-7f;
    }
    for (std::size_t i = 0; i < d.sorted.size(); ++i) d.sorted[i] = i * 67'000'000;
    return d;
  }();
  return made;
}

void integers() {
  std::uint64_t a = g_result, b = a + 1, c = a + 2;
  for (int i = 0; i < 200'000; ++i) {
    a ^= a << 13;
    b += a >> 7;
    c ^= b << 17;
    a -= c;
  }
  g_result = a ^ b ^ c;
}

void multiplications() {
  std::uint64_t a = g_result, b = a + 1, c = a + 2, d = a + 3;
  for (int i = 0; i < 200'000; ++i) {
    a = a * 6364136223846793005u + 1;
    b = b * 3935559000370003845u + 1;
    c = c * 2862933555777941757u + 1;
    d = d * 3202034522624059733u + 1;
  }
  g_result = a ^ b ^ c ^ d;
}

void divisions() {
  std::uint64_t a = g_result | 1, sum = 0;
  for (std::uint64_t i = 1; i < 50'000; ++i) {
    sum += (a + i * 1'000'003) / (i | 1);
    a ^= sum;
  }
  g_result = sum;
}

void lookups() {
  const Data& d = data();
  std::uint64_t sum = 0;
  for (int round = 0; round < 100; ++round)
    for (std::size_t i = 0; i < kSize; ++i) sum += d.words[d.bytes[i] * 16u + i % 16u];
  g_result = sum;
}

void histogram() {
  Data& d = data();
  std::array<std::uint32_t, 256> bins{};
  for (int round = 0; round < 100; ++round)
    for (std::size_t i = 0; i < kSize; ++i) ++bins[d.bytes[i]];
  g_result = bins[g_result % 256];
}

void stores() {
  Data& d = data();
  for (int round = 0; round < 100; ++round)
    for (std::size_t i = 0; i < kSize; ++i)
      d.words[i * 5 % kSize] = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(round);
  g_result = d.words[7];
}

void searches() {
  const Data& d = data();
  std::uint64_t sum = 0;
  std::uint32_t key = 1;
  for (int i = 0; i < 40'000; ++i) {
    key = key * 1664525u + 1013904223u;
    sum += static_cast<std::uint64_t>(std::lower_bound(d.sorted.begin(), d.sorted.end(), key) -
                                      d.sorted.begin());
  }
  g_result = sum;
}

void polynomials() {
  double a = g_real, b = a + 0.1, c = a + 0.2, d = a + 0.3;
  for (int i = 0; i < 100'000; ++i) {
    a = a * 0.5 + 0.25;
    b = b * 0.25 + a;
    c = c * 0.125 - b;
    d = d * 0.5 + c;
  }
  g_real = 1.5 + 1e-9 * (a + b + c + d);
}

void real_divisions() {
  double a = g_real, sum = 0.0;
  for (int i = 0; i < 40'000; ++i) {
    sum += 1.0 / (a + i);
    a = std::sqrt(a * a + 1e-3);
  }
  g_real = 1.5 + 1e-9 * sum;
}

void vectors_of_reals() {
  Data& d = data();
  const float factor = static_cast<float>(g_real) * 1e-3f;
  for (int round = 0; round < 400; ++round)
    for (std::size_t i = 0; i < kSize; ++i) d.sums[i] += factor * d.reals[i];
  g_real = 1.5 + 1e-12 * static_cast<double>(d.sums[3]);
}

void vectors_of_bytes() {
  Data& d = data();
  for (int round = 0; round < 400; ++round)
    for (std::size_t i = 0; i < kSize; ++i)
      d.others[i] = static_cast<std::uint8_t>((d.others[i] & d.bytes[i]) + 3);
  g_result = d.others[5];
}

void atomics() {
  static std::atomic<std::uint64_t> shared{0};
  for (int i = 0; i < 40'000; ++i) shared.fetch_add(static_cast<std::uint64_t>(i));
  g_result = shared;
}

constexpr Kernel kKernels[] = {{kChain, integers},
                               {"multiplications", multiplications},
                               {"divisions", divisions},
                               {"lookups", lookups},
                               {"histogram", histogram},
                               {"stores", stores},
                               {"searches", searches},
                               {"polynomials", polynomials},
                               {"real_divisions", real_divisions},
                               {"vectors_of_reals", vectors_of_reals},
                               {"vectors_of_bytes", vectors_of_bytes},
                               {"atomics", atomics}};

}  // namespace

std::span<const Kernel> kernels() {
  return kKernels;
}

}  // namespace tether::calibration
