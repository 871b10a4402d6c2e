#pragma once

namespace tether::vision {

/// Sets the number of threads for image processing in the whole process; 1: only the caller's. A
/// SUT whose time is the CPU time of its process must use 1.
void set_threads(int count);

/// Tracks an anchor through a few generated images of this size, so that one-time costs (lazy
/// initialisation, page faults) occur before a SUT's time begins.
void warm_up(int width_px, int height_px);

}  // namespace tether::vision
