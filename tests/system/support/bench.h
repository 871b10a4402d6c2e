#pragma once

#include <filesystem>

namespace tether::system_test {

/// Real sensors where there are none: what the project's own simulator sees 2.9 m in front of the
/// blue box of data/worlds/room.sdf, straight ahead, as files that look like devices. Camera and
/// rangefinder are those of data/rigs/bench.toml.
struct Bench {
  std::filesystem::path video;  ///< Motion JPEG, 640 × 480 at 30 Hz
  std::filesystem::path range;  ///< a folder like /sys/bus/iio/devices/iio:device0
  double distance_m = 0.0;      ///< from the camera to the box' centre
};

/// @param frames of the video; it is `frames` / 30 s long
Bench make_bench(const std::filesystem::path& folder, int frames);

/// An IIO folder of a rangefinder, in millimetres.
void write_range_folder(const std::filesystem::path& folder, int range_mm);

}  // namespace tether::system_test
