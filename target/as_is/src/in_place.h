#pragma once

#include "agent.h"
#include "real.h"

/// What the functions in place of the C library's have in common.
#define TETHER_IN_PLACE extern "C" __attribute__((visibility("default")))

namespace tether::as_is {

/// The agent, if the calling thread is the program's and the process is under test; else nullptr:
/// then the real function is what is wanted.
inline Agent* agent() {
  return Inside::is() ? nullptr : Agent::get();
}

}  // namespace tether::as_is
