#include "rig_file.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <tether/base/result.h>
#include <tether/rig/device_arguments.h>

// Combines the rig's file with devices of the command line: assigns each device to a sensor of its
// kind, removes sensors without a device, and checks that the sensors of each task have a device
// and, for tasks with an anchor, a lens.
namespace tether::rig {
namespace {

using uav::SensorKind;

/// What a task's option for a sensor's name refers to.
std::string* imu_of(TaskSpec& spec) {
  if (auto* forward = std::get_if<tasks::MoveForwardOptions>(&spec.options)) {
    return &forward->face.imu;
  }
  if (auto* path = std::get_if<tasks::ClosedPathOptions>(&spec.options)) return &path->imu;
  if (auto* way = std::get_if<tasks::GoToOptions>(&spec.options)) return &way->imu;
  if (auto* hold = std::get_if<tasks::HoldOptions>(&spec.options)) return &hold->imu;
  if (auto* land = std::get_if<tasks::LandOptions>(&spec.options)) return &land->imu;
  if (auto* land_on = std::get_if<tasks::LandOnOptions>(&spec.options)) return &land_on->imu;
  return nullptr;
}

bool has_anchor(const TaskSpec& spec) {
  return !std::holds_alternative<tasks::SensorCharacterizationOptions>(spec.options) &&
         !std::holds_alternative<tasks::GoToOptions>(spec.options) &&
         !std::holds_alternative<tasks::HoldOptions>(spec.options) &&
         !std::holds_alternative<tasks::LandOptions>(spec.options) &&
         !std::holds_alternative<tasks::AvoidByScanOptions>(spec.options) &&
         !std::holds_alternative<tasks::FlyThroughGatesOptions>(spec.options);
}

/// A device stands here until the rig says the sensor's name.
void take(std::string& name, std::string& device) {
  if (devices::is_device(name)) device = std::exchange(name, "");
}

std::string option_of(SensorKind kind) {
  return "--" + std::string(uav::name(kind));
}

std::vector<devices::RigSensor*> sensors_of(devices::Rig& rig, SensorKind kind) {
  std::vector<devices::RigSensor*> sensors;
  for (devices::RigSensor& sensor : rig.sensors) {
    if (sensor.description.kind() == kind) sensors.push_back(&sensor);
  }
  return sensors;
}

devices::RigSensor* find(devices::Rig& rig, const std::string& name) {
  const auto found =
      std::find_if(rig.sensors.begin(), rig.sensors.end(),
                   [&](const devices::RigSensor& s) { return s.description.name == name; });
  return found == rig.sensors.end() ? nullptr : &*found;
}

/// The rig's sensor that a device of this kind is for: the one that is named like its kind, or the
/// only one.
Result<devices::RigSensor*> sensor_for(devices::Rig& rig, SensorKind kind,
                                       const std::string& file) {
  const std::string plain_name(uav::name(kind));
  const std::vector<devices::RigSensor*> sensors = sensors_of(rig, kind);
  devices::RigSensor* named = find(rig, plain_name);
  if (named != nullptr && named->description.kind() == kind) return named;
  if (sensors.size() == 1) return sensors.front();
  return invalid(file + ": " + option_of(kind) + " DEVICE needs exactly one sensor of kind " +
                 plain_name + ", or one of that name; the file has " +
                 std::to_string(sensors.size()));
}

/// The name of the sensor that got the device.
Result<std::string> give(devices::Rig& rig, SensorKind kind, const std::string& device,
                         const std::string& file) {
  if (file.empty()) rig.sensors.push_back(plain_sensor(kind, std::string(uav::name(kind))));
  const Result<devices::RigSensor*> sensor = sensor_for(rig, kind, file);
  if (!sensor) return sensor.failure();
  (*sensor)->device = device;
  return (*sensor)->description.name;
}

void fill_in(Mission& mission, SensorKind kind, const std::string& name) {
  for (TaskSpec& spec : mission.tasks) {
    std::string* const place = kind == SensorKind::kCamera ? &spec.vision.camera : imu_of(spec);
    if (kind != SensorKind::kRange && place != nullptr && place->empty()) *place = name;
  }
}

Status give_all(devices::Rig& rig, const DeviceArguments& arguments, Mission& mission) {
  const std::vector<std::pair<SensorKind, const std::string*>> given = {
      {SensorKind::kCamera, &arguments.camera},
      {SensorKind::kImu, &arguments.imu},
      {SensorKind::kRange, &arguments.range}};
  for (const auto& [kind, device] : given) {
    if (device->empty()) continue;
    const Result<std::string> name = give(rig, kind, *device, arguments.rig);
    if (!name) return name.failure();
    fill_in(mission, kind, *name);
  }
  return ok_status();
}

// What a mission needs ----------------------------------------------------------------------------

/// Sensors that are not in the rig at all are the task's to miss.
Status check_device(devices::Rig& rig, const std::string& sensor, const std::string& file) {
  const devices::RigSensor* found = find(rig, sensor);
  if (found != nullptr && found->device.empty()) {
    const std::string option = option_of(found->description.kind());
    return invalid(file + ": sensor \"" + sensor + "\" has no device; give " + option +
                   " DEVICE, or set device in the file");
  }
  return ok_status();
}

Status check_lens(devices::Rig& rig, const std::string& camera, const std::string& file) {
  const devices::RigSensor* found = find(rig, camera);
  const auto* properties = found != nullptr
                               ? std::get_if<uav::CameraProperties>(&found->description.properties)
                               : nullptr;
  if (properties != nullptr && properties->model.fx_px == 0.0 && found->horizontal_fov_rad == 0.0) {
    return invalid(file + ": camera \"" + camera +
                   "\" needs horizontal_fov_deg (or size_px and intrinsics): a task with an "
                   "anchor computes angles from pixels");
  }
  return ok_status();
}

Status check_task(devices::Rig& rig, TaskSpec& spec, const std::string& file) {
  if (!has_anchor(spec)) return check_device(rig, spec.sensor, file);
  if (file.empty()) {
    return invalid(
        "a task with an anchor needs --rig FILE as well: only a rig file describes the anchor and "
        "the camera's lens");
  }
  if (Status lens = check_lens(rig, spec.vision.camera, file); !lens) return lens;
  if (const std::string* imu = imu_of(spec); imu != nullptr) {
    if (Status device = check_device(rig, *imu, file); !device) return device;
  }
  return check_device(rig, spec.vision.camera, file);
}

Status check_rig(devices::Rig& rig, Mission& mission, const std::string& file) {
  for (TaskSpec& spec : mission.tasks) {
    if (Status status = check_task(rig, spec, file); !status) return status;
  }
  const auto unused = std::remove_if(rig.sensors.begin(), rig.sensors.end(),
                                     [](const auto& sensor) { return sensor.device.empty(); });
  rig.sensors.erase(unused, rig.sensors.end());
  if (rig.sensors.empty()) {
    return invalid(file +
                   ": no sensor has a device; give --camera, --imu or --range DEVICE, or set "
                   "device in the file");
  }
  return ok_status();
}

}  // namespace

void take_devices(TaskSpec& spec, DeviceArguments& arguments) {
  if (has_anchor(spec)) take(spec.vision.camera, arguments.camera);
  if (std::string* imu = imu_of(spec)) take(*imu, arguments.imu);
}

Result<std::optional<devices::Rig>> make_rig(const DeviceArguments& arguments, Mission& mission) {
  const bool is_real =
      !(arguments.rig + arguments.camera + arguments.imu + arguments.range).empty();
  if (!is_real) return std::optional<devices::Rig>();
  devices::Rig rig{"rig", {}, {}};
  if (!arguments.rig.empty()) {
    Result<devices::Rig> loaded = load_rig(arguments.rig);
    if (!loaded) return loaded.failure();
    rig = std::move(loaded).value();
  }
  if (const Status given = give_all(rig, arguments, mission); !given) return given.failure();
  if (const Status good = check_rig(rig, mission, arguments.rig); !good) return good.failure();
  return std::optional<devices::Rig>(std::move(rig));
}

}  // namespace tether::rig
