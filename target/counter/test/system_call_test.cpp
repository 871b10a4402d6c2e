#include "system_call.h"

#include <gtest/gtest.h>

namespace tether::counter {
namespace {

using enum SystemCall;

struct CallCase {
  const char* name;
  int x86_64, aarch64;
  std::uint64_t first, second;
  SystemCall call;
};

TEST(SystemCallOf, IsKnownForBothArchitectures) {
  constexpr std::uint64_t kPrivate = 128, kRealTime = 256;
  const CallCase cases[] = {{"read", 0, 63, 3, 0, kWaits},
                            {"write", 1, 64, 3, 0, kShort},
                            {"ppoll", 271, 73, 0, 0, kWaits},
                            {"clock_gettime", 228, 113, 1, 0, kReadsClock},
                            {"clone of a thread", 56, 220, 0x3d0f00, 0, kStartsThread},
                            {"clone of a process", 56, 220, 0x4111, 0, kStartsProcess},
                            {"exit", 60, 93, 0, 0, kEndsThread},
                            {"exit_group", 231, 94, 0, 0, kShort},
                            {"futex wait", 202, 98, 0, 0 | kPrivate, kWaits},
                            {"futex wait_bitset", 202, 98, 0, 9 | kPrivate | kRealTime, kWaits},
                            {"futex wake", 202, 98, 0, 1 | kPrivate, kWakes},
                            {"unknown", 100'000, 100'000, 0, 0, kShort}};
  for (const CallCase& one : cases) {
    EXPECT_EQ(system_call(false, one.x86_64, one.first, one.second), one.call) << one.name;
    EXPECT_EQ(system_call(true, one.aarch64, one.first, one.second), one.call) << one.name;
  }
  EXPECT_EQ(system_call(false, 57, 0, 0), kStartsProcess) << "fork";
  EXPECT_EQ(system_call(true, 57, 0, 0), kShort) << "close";
}

}  // namespace
}  // namespace tether::counter
