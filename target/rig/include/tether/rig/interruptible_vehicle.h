#pragma once

#include <functional>
#include <memory>

#include <tether/client/vehicle.h>

namespace tether::rig {

/// The same vehicle, whose interactions fail with kRunEnded, "interrupted", as soon as
/// `is_interrupted` says so: so a task ends as on any other failure, and its devices are closed. A
/// failure that an interrupt brought about is named as one. `finish` goes through: what is done
/// when the interrupt comes stays done.
std::unique_ptr<client::Vehicle> make_interruptible(std::unique_ptr<client::Vehicle> vehicle,
                                                    std::function<bool()> is_interrupted);

/// From now on the first SIGINT or SIGTERM only makes `interrupted` true; the next one ends the
/// process as usual. Whole process.
void catch_interrupts();
bool interrupted();

}  // namespace tether::rig
