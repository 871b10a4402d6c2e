#pragma once

#include <functional>
#include <memory>

#include <tether/client/vehicle.h>

namespace tether::rig {

/// The same vehicle, except that its interactions fail with kRunEnded, "interrupted", once
/// `is_interrupted` returns true. A failure caused by the interrupt is reported in the same way.
/// `finish` still works, so that a finished task is reported as finished.
std::unique_ptr<client::Vehicle> make_interruptible(std::unique_ptr<client::Vehicle> vehicle,
                                                    std::function<bool()> is_interrupted);

/// Installs handlers for the whole process: the first SIGINT or SIGTERM, and every SIGHUP (the
/// terminal was closed) unless it is ignored, makes `interrupted` true. The next SIGINT or SIGTERM
/// ends the process. SIGPIPE is ignored: output that nobody reads any more ends nothing.
void catch_interrupts();
bool interrupted();

}  // namespace tether::rig
