#include "system_call.h"

/// System calls of Linux on x86-64 (arch/x86/entry/syscalls/syscall_64.tbl) and 64-bit ARM
/// (include/uapi/asm-generic/unistd.h).
namespace tether::counter {
namespace {

using enum SystemCall;

struct Number {
  std::int16_t x86_64, aarch64;  // -1: there is none
  SystemCall call;
};

constexpr Number kCalls[] = {
    {0, 63, kWaits},           // read
    {7, -1, kWaits},           // poll
    {17, 67, kWaits},          // pread64
    {19, 65, kWaits},          // readv
    {23, -1, kWaits},          // select
    {24, 124, kWaits},         // sched_yield
    {34, -1, kWaits},          // pause
    {35, 101, kWaits},         // nanosleep
    {42, 203, kWaits},         // connect
    {43, 202, kWaits},         // accept
    {45, 207, kWaits},         // recvfrom
    {47, 212, kWaits},         // recvmsg
    {61, 260, kWaits},         // wait4
    {65, 193, kWaits},         // semop
    {70, 188, kWaits},         // msgrcv
    {73, 32, kWaits},          // flock
    {128, 137, kWaits},        // rt_sigtimedwait
    {130, 133, kWaits},        // rt_sigsuspend
    {208, 4, kWaits},          // io_getevents
    {220, 192, kWaits},        // semtimedop
    {230, 115, kWaits},        // clock_nanosleep
    {232, -1, kWaits},         // epoll_wait
    {243, 183, kWaits},        // mq_timedreceive
    {247, 95, kWaits},         // waitid
    {270, 72, kWaits},         // pselect6
    {271, 73, kWaits},         // ppoll
    {281, 22, kWaits},         // epoll_pwait
    {288, 242, kWaits},        // accept4
    {295, 69, kWaits},         // preadv
    {299, 243, kWaits},        // recvmmsg
    {96, 169, kReadsClock},    // gettimeofday
    {201, -1, kReadsClock},    // time
    {228, 113, kReadsClock},   // clock_gettime
    {57, -1, kStartsProcess},  // fork
    {58, -1, kStartsProcess},  // vfork
    {60, 93, kEndsThread},     // exit
};

struct Special {
  std::int64_t x86_64, aarch64;
};
constexpr Special kClone = {56, 220}, kFutex = {202, 98};

SystemCall clone_call(std::uint64_t flags) {
  constexpr std::uint64_t kCloneThread = 0x10000;
  return (flags & kCloneThread) != 0 ? kStartsThread : kStartsProcess;
}

SystemCall futex_call(std::uint64_t operation) {
  constexpr std::uint64_t kOptions = 128 | 256;  // private, of the real-time clock
  switch (operation & ~kOptions) {
    case 1:   // FUTEX_WAKE
    case 5:   // FUTEX_WAKE_OP
    case 10:  // FUTEX_WAKE_BITSET
      return kWakes;
    case 3:  // FUTEX_REQUEUE
    case 4:  // FUTEX_CMP_REQUEUE
    case 7:  // FUTEX_UNLOCK_PI
      return kShort;
    default:
      return kWaits;
  }
}

}  // namespace

SystemCall system_call(bool is_arm, std::int64_t number, std::uint64_t first,
                       std::uint64_t second) {
  const auto number_of = [is_arm](const auto& row) { return is_arm ? row.aarch64 : row.x86_64; };
  if (number == number_of(kClone)) return clone_call(first);
  if (number == number_of(kFutex)) return futex_call(second);
  for (const Number& row : kCalls)
    if (number == number_of(row)) return row.call;
  return kShort;
}

}  // namespace tether::counter
