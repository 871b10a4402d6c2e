#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/client/sut_clock.h>
#include <tether/os/counted_program.h>

namespace tether::client {

/// Counted work × its costs. A reading is exact and does not depend on how the machine is loaded:
/// from `elapsed_at_resume` to `elapsed` the same work takes the same time, whatever was counted
/// before. `complete()` fails once two threads have computed at the same time, a process was
/// started, or nothing was counted since the last reply. @pre the plugin counts in `page`
std::unique_ptr<TimeSource> source_of(os::MappedCounts page);

/// The clock of a program that runs under an emulator with Tether's plugin. `file`: its page of
/// counts. Waits for a moment until no other thread computes. Fails with kInvalid if the page is
/// missing, of another version, or does not count this program, and with kRefused if another thread
/// or process of it computes.
Result<std::unique_ptr<TimeSource>> make_counted_source(const std::string& file);

}  // namespace tether::client
