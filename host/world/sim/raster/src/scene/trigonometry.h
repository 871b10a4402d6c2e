#pragma once

namespace tether::raster {

// The standard library's functions may differ in the last bit from machine to machine.

/// Of an angle within 0 and π/2 [rad], to 1e-15.
double sine(double angle_rad);
double cosine(double angle_rad);

}  // namespace tether::raster
