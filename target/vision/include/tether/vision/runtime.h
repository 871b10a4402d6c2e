#pragma once

namespace tether::vision {

/// Threads that image processing may use, in the whole process; 1: none but the caller's. A SUT
/// whose time is the CPU time of its process must say 1.
void set_threads(int count);

/// Tracks an anchor through a few drawn images of this size, so that what is slow only once (lazy
/// initialisation, first touch of memory) is over before a SUT's time begins.
void warm_up(int width_px, int height_px);

}  // namespace tether::vision
