#pragma once

#include "remote_session.h"

#include <string>

#include <tether/sim_sensing/sensor_suite.h>
#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {

/// Rays cast by the simulator at the other end.
class RemoteRays final : public RayCaster {
 public:
  /// `session` must outlive this object.
  explicit RemoteRays(RemoteSession& session) : session_(session) {}
  void cast(const RayBundle& bundle, std::span<double> distances_m) override;

 private:
  RemoteSession& session_;
};

/// Pictures drawn by the simulator at the other end.
class RemoteRenderer final : public ViewRenderer {
 public:
  /// `session` must outlive this object.
  explicit RemoteRenderer(RemoteSession& session) : session_(session) {}
  void render(const View& view, std::span<std::uint8_t> rgb) override;
  double nearest_depth_m() override { return nearest_depth_m_; }
  std::string name() const override { return name_; }

 private:
  RemoteSession& session_;
  double nearest_depth_m_ = 0.0;
  std::string name_;
};

}  // namespace tether::sim
