#pragma once

#include <tether/runner/trial_server.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::app {

/// What a server of trials does: reads their worlds into `worlds`, which outlives it, and does what
/// `tether run` would.
runner::TrialService trial_service(sim::WorldStore& worlds);

}  // namespace tether::app
