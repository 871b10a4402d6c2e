#include <algorithm>

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
  switch (kind) {
    case SensorKind::kCamera:
      return "camera";
    case SensorKind::kImu:
      return "imu";
    case SensorKind::kRange:
      return "range";
  }
  return "unknown";
}

std::string_view name(AnchorShape shape) {
  switch (shape) {
    case AnchorShape::kBox:
      return "box";
    case AnchorShape::kCylinder:
      return "cylinder";
    case AnchorShape::kSphere:
      return "sphere";
  }
  return "unknown";
}

const SensorDescription* Catalogue::find_sensor(std::string_view sensor) const {
  return find_by_name(sensors, sensor);
}

const Anchor* Catalogue::find_anchor(std::string_view anchor) const {
  return find_by_name(anchors, anchor);
}

}  // namespace tether::uav
