#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

/// The page through which a program's work is counted: the host creates it, the plugin of the
/// emulator that runs the program adds to it, and the client library in the program reads it
/// (docs/design.md section 2, clock `counted`). Plain data at the same place in each of the three,
/// also if the program is for another architecture: little-endian, 64-bit.
namespace tether {

/// Kinds of work of a machine. An instruction that computes with an operand in memory is work of
/// two or three kinds: load, computation, store.
enum class WorkClass : std::uint8_t {
  kInteger,
  kMultiply,
  kDivide,  ///< and square roots, of integers and floating-point numbers
  kLoad,
  kStore,
  kBranch,
  kScalarFloat,
  kVectorFloat,
  kVectorInteger,  ///< and moves, shuffles and logic of vector registers
  kAtomic,
};
inline constexpr std::size_t kWorkClasses = 10;

/// As in target files, in the order of WorkClass.
inline constexpr std::array<const char*, kWorkClasses> kWorkClassNames = {
    "integer", "multiply",     "divide",       "load",           "store",
    "branch",  "scalar_float", "vector_float", "vector_integer", "atomic"};

/// Costs are whole numbers of this many parts of a nanosecond, so that sums are exact.
inline constexpr std::int64_t kCostUnitsPerNs = 100'000;

/// Why what a program computes cannot be counted.
enum class CountFault : std::uint32_t {
  kNone = 0,
  kThreads = 1,  ///< two of its threads could compute at the same time
  kProcess = 2,  ///< it started a process, whose work is not counted
  kClock = 3,    ///< it asks for the machine's time again and again, on which its work depends
};

struct CountPage {
  static constexpr std::uint64_t kMagic = 0x544E434852544554;  // "TETHRCNT"
  static constexpr std::uint32_t kVersion = 2;

  // By the host, before the program starts.
  std::uint64_t magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t classes = kWorkClasses;
  /// Of each piece of work. All 0: the work is counted in `counts`, else in `units`.
  std::array<std::uint64_t, kWorkClasses> cost_units{};

  // By the plugin.
  std::atomic<std::uint32_t> plugin_version{0};  ///< kVersion once it counts
  std::atomic<std::uint32_t> fault{0};           ///< a CountFault, while `watched`
  std::atomic<std::uint32_t> computing{0};       ///< threads that compute, or that could
  // By the client library.
  std::atomic<std::uint32_t> watched{0};  ///< 1: in flight, so that the plugin sets `fault`
  std::atomic<std::uint32_t> held{0};     ///< 1: the program waits for a reply
  std::uint32_t unused = 0;

  // By the plugin, in cache lines of their own.
  alignas(64) std::atomic<std::uint64_t> units{0};  ///< what the work has cost
  std::array<std::atomic<std::uint64_t>, kWorkClasses> counts{};

  bool has_costs() const { return cost_units != decltype(cost_units){}; }
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(sizeof(CountPage) <= 4096);

}  // namespace tether
