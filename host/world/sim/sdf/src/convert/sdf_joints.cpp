#include "convert/sdf_convert.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tether::sim {
namespace {

constexpr double kLargestAngle_rad = 100.0;

/// None for a joint that its program cannot turn: of another type, or without limits.
std::optional<uav::Joint> read_joint(const SdfSource& source, const sdf::Joint& joint,
                                     const uav::Pose& X_BM) {
  const sdf::JointAxis* axis = joint.Axis(0);
  if (joint.Type() != sdf::JointType::REVOLUTE || axis == nullptr) return std::nullopt;
  const double min_rad = axis->Lower(), max_rad = axis->Upper(), rate = axis->MaxVelocity();
  const bool has_limits = std::abs(min_rad) <= kLargestAngle_rad &&
                          std::abs(max_rad) <= kLargestAngle_rad && min_rad <= max_rad &&
                          std::isfinite(rate) && rate > 0.0;
  if (!has_limits) return std::nullopt;
  ignition::math::Pose3d X_MJ;
  ignition::math::Vector3d axis_M;
  if (!joint.SemanticPose().Resolve(X_MJ, "__model__").empty() ||
      !axis->ResolveXyz(axis_M, "__model__").empty())
    refuse(source, joint.Element(), "has a pose or an axis that cannot be resolved");
  return uav::Joint{
      joint.Name(), (X_BM * to_pose(X_MJ)).p, rotate(X_BM.q, to_vec3(axis_M)), min_rad, max_rad,
      rate};
}

}  // namespace

void add_joint_state(const SdfSource& source, const sdf::ElementPtr& model, Uav& uav) {
  constexpr const char* kName = "joint_state";
  if (uav.joints.empty() || std::ranges::count(uav.sensors, kName, &Sensor::name) > 0) return;
  uav.sensors.push_back({kName, {}, 0.0, JointStateModel{}, source.where(model)});
}

Joints read_joints(const SdfSource& source, const sdf::Model& model, const std::string& body,
                   const uav::Pose& X_BM, const std::set<std::string>& of_rotors) {
  Joints found;
  found.behind[body] = 0;
  bool has_grown = true;
  const auto add = [&](const std::string& link, std::size_t behind) {
    has_grown |= found.behind.emplace(link, behind).second;
  };
  while (std::exchange(has_grown, false)) {
    for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
      const sdf::Joint& joint = *model.JointByIndex(i);
      const auto parent = found.behind.find(joint.ParentLinkName());
      const auto child = found.behind.find(joint.ChildLinkName());
      const bool has_parent = parent != found.behind.end(), has_child = child != found.behind.end();
      if (has_parent == has_child) continue;
      if (joint.Type() == sdf::JointType::FIXED) {
        if (has_parent)
          add(joint.ChildLinkName(), parent->second);
        else
          add(joint.ParentLinkName(), child->second);
        continue;
      }
      const std::size_t count = found.chain.size();
      if (!has_parent || parent->second != count || count == uav::kMaxJoints) continue;
      if (of_rotors.contains(joint.Name())) continue;
      if (auto next = read_joint(source, joint, X_BM)) {
        found.chain.push_back(std::move(*next));
        add(joint.ChildLinkName(), count + 1);
      }
    }
  }
  return found;
}

}  // namespace tether::sim
