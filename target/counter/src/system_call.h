#pragma once

#include <cstdint>

namespace tether::counter {

/// What a system call means for the turns of threads.
enum class SystemCall : std::uint8_t {
  kShort,          ///< returns at once, in most cases
  kWaits,          ///< may wait for something that another thread does
  kWakes,          ///< returns how many threads it has woken
  kReadsClock,     ///< of the machine
  kStartsThread,   ///
  kStartsProcess,  ///
  kEndsThread,     ///< never returns
};

/// Of a call by its number and first arguments. A call that is not known is short.
SystemCall system_call(bool is_arm, std::int64_t number, std::uint64_t first, std::uint64_t second);

}  // namespace tether::counter
