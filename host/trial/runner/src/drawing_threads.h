#pragma once

#include <tether/runner/trial.h>
#include <tether/sim/world.h>

namespace tether::runner {

/// How many threads may draw pictures while the program computes: as many as there are cameras, and
/// at most one less than the `cores` that share no execution units, so that the program keeps one.
/// None if they could distort the program's time, which is true for a clock of wall time unless the
/// program runs on a board; none in free running, where nothing is known ahead.
int drawing_threads(const TrialSpec& spec, const sim::World& world, int cores);

}  // namespace tether::runner
