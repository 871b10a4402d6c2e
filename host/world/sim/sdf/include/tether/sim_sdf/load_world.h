#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/sim/file_cache.h>
#include <tether/sim/world.h>

namespace tether::sim {

/// Reads world and UAV models (SDFormat up to 1.9, and what it knows of later versions) and
/// resolves every pose, include, mesh and texture, as docs/guide/worlds.md says. `warn` receives a
/// warning, with file and line, for each element that Tether cannot represent, and for what
/// `request.options` allow to mend or to leave out.
///
/// Nested models become separate models named "outer::inner". A UAV's body is its link
/// "base_link", else its first one. Its airframe is its <tether:multirotor>, and links fixed to the
/// body are merged into it; else it is what the plugins of its motors say, and all links are one
/// body with the mass of all (docs/guide/your-own-uav.md). What is missing of drag, motors and
/// limits is as of models/hummingbird/model.sdf.
///
/// @throws Error(kBadFile) with file, line and element for input that cannot be used: missing file,
///   XML or SDF errors, not exactly one <world>, numbers followed by a unit or other text,
///   impossible values (negative mass or size, lengths and positions beyond 1e5 m, more than 1e6
///   kg, more than `kMaxMovingLinks`, zero-size image, gravity that does not point down, a step
///   outside 10 µs to 20 ms), two UAVs of one name, an anchor that is not a model with one
///   untextured box, cylinder or sphere, a UAV model without rotors that are known, with two
///   sensors of one name, a centre of mass off its origin, or less thrust than weight.
///   Error(kSetup) if there is no room in the folder of temporary files.
///
/// Not thread-safe: std::cerr and libsdformat's console are silenced while this runs.
World load_world(const WorldRequest& request, const WarningSink& warn);

/// The UAV of a model's file, without a name and a place, as in a world with such gravity. Errors
/// and thread safety as of `load_world`.
Uav load_uav(const std::filesystem::path& model, const WorldOptions& options, double gravity_m_s2,
             const WarningSink& warn);

/// An external simulator that reads the world's SDF files itself, and the latest SDF version that
/// it reads.
struct SdfReader {
  std::string name;  ///< "Gazebo 11"
  int major = 1;
  int minor = 7;
};

/// @throws Error(kBadFile) with file and line for the first of the world's `sdf_files` with a later
/// version than the reader's, or with a shape that the reader's version lacks: <capsule> and
/// <ellipsoid> were introduced in SDF 1.8.
void check_sdf_version(const World& world, const SdfReader& reader);

/// Worlds that were read, so that trials that differ in the start poses of their UAVs read them
/// once. Not thread-safe.
class WorldStore {
 public:
  /// Finds worlds also in a cache, and keeps those there that it reads. None: reads them. A world
  /// with a file that changed less than `tick` ago is not kept: another change may not show in the
  /// file's times.
  explicit WorldStore(std::optional<FileCache> cache = std::nullopt, Duration tick = kFileTick)
      : cache_(std::move(cache)), tick_(tick) {}

  /// As load_world, with the same warnings. Does not notice that a file has changed since the store
  /// has the world. From the cache, a world is what reading it would give now.
  World load(const WorldRequest& request, const WarningSink& warn);

 private:
  struct Stored {
    WorldRequest request;
    World world;
    std::vector<Warning> warnings;
  };
  const Stored& find(const WorldRequest& request);
  Stored make(const WorldRequest& request) const;

  std::optional<FileCache> cache_;
  Duration tick_;
  std::vector<Stored> stored_;
};

}  // namespace tether::sim
