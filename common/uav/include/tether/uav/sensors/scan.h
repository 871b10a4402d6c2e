#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tether/base/time.h>

namespace tether::uav {

/// Most rays of a scan.
inline constexpr std::size_t kMaxScanRays = 1u << 18;

/// Where the rays of a lidar point: rows of one elevation, each with columns of one azimuth, evenly
/// spaced from the first to the last; a single one lies in the middle.
struct ScanProperties {
  int columns = 1;
  int rows = 1;
  double min_azimuth_rad = 0.0;  ///< about S's z, from its x
  double max_azimuth_rad = 0.0;
  double min_elevation_rad = 0.0;  ///< up from S's x-y plane
  double max_elevation_rad = 0.0;
  double min_m = 0.0;
  double max_m = 0.0;
  /// From the first column to the last; all at once: 0. The last one is measured at `sampled_at`,
  /// column c so much earlier: sweep_s·(columns − 1 − c)/(columns − 1).
  double sweep_s = 0.0;
};

/// One scan of a lidar.
struct ScanSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  /// Row by row from the lowest elevation; +inf: nothing within range, −inf: closer than the
  /// minimum (REP-117).
  std::vector<float> ranges_m;
  /// Of each range, how much of the light comes back; 0 where it is not finite. Empty: not known.
  std::vector<float> intensities{};
};

}  // namespace tether::uav
