#pragma once

#include <memory>

#include <tether/client/sut_clock.h>

namespace tether::as_is {

/// A source of CPU time that also charges what other threads of this process compute during a call,
/// after it, as it does for child processes. Threads of a program as it is go on while one of them
/// calls. Others are returned as they are.
std::unique_ptr<client::TimeSource> charge_beside_calls(std::unique_ptr<client::TimeSource> source);

/// With a wall clock, which stands during calls: what other threads have computed during them.
Duration computed_beside_calls();

}  // namespace tether::as_is
