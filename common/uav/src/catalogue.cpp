#include <algorithm>

#include <tether/base/text.h>
#include <tether/uav/catalogue.h>

namespace tether::uav {
namespace {

template <class T>
const T* find_by_name(const std::vector<T>& things, std::string_view name) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [name](const T& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

}  // namespace

std::string_view name(SensorKind kind) {
  return enum_name(kind, {"camera", "imu", "range", "navsat", "magnetometer", "barometer",
                          "odometry", "scan", "joint_state"});
}

std::string_view name(CameraKind kind) {
  return enum_name(kind, {"camera", "depth camera", "rgbd camera", "segmentation camera"});
}

std::optional<CameraKind> SensorDescription::camera_kind() const {
  const auto* camera = std::get_if<CameraProperties>(&properties);
  return camera == nullptr ? std::nullopt : std::optional(camera->kind);
}

std::string_view SensorDescription::kind_name() const {
  const auto of_camera = camera_kind();
  return of_camera ? uav::name(*of_camera) : uav::name(kind());
}

std::string_view name(AnchorShape shape) {
  return enum_name(shape, {"box", "cylinder", "sphere"});
}

const SensorDescription* Catalogue::find_sensor(std::string_view sensor) const {
  return find_by_name(sensors, sensor);
}

const Anchor* Catalogue::find_anchor(std::string_view anchor) const {
  return find_by_name(anchors, anchor);
}

}  // namespace tether::uav
