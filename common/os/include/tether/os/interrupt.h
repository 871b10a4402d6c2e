#pragma once

namespace tether::os {

/// From now on SIGINT and SIGTERM only set a flag; one that comes half a
/// second later or more ends the process at once. Call
/// once, early.
void catch_interrupts();
/// Whether one has come.
bool interrupted();

}  // namespace tether::os
