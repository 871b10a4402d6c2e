#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <tether/base/text.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

using nlohmann::json;

void annotate(client::Vehicle& vehicle, std::string_view topic, const json& note) {
  (void)vehicle.annotate(topic, note.dump(-1, ' ', false, json::error_handler_t::replace));
}

Failure no_such(std::string_view kind, std::string_view name,
                const std::vector<std::string_view>& known) {
  return {Failure::Kind::kInvalid, "there is no " + std::string(kind) + " \"" + std::string(name) +
                                       "\"; " + allowed_hint(name, known)};
}

/// @param kind  of the sensors; all if none is given
std::vector<std::string_view> sensor_names(const uav::Catalogue& catalogue,
                                           std::optional<uav::SensorKind> kind = {}) {
  std::vector<std::string_view> names;
  for (const uav::SensorDescription& sensor : catalogue.sensors)
    if (!kind || sensor.kind() == *kind) names.push_back(sensor.name);
  return names;
}

std::vector<std::string_view> anchor_names(const uav::Catalogue& catalogue) {
  std::vector<std::string_view> names;
  for (const uav::Anchor& anchor : catalogue.anchors) names.push_back(anchor.name);
  return names;
}

}  // namespace

TaskContext::TaskContext(client::Vehicle& vehicle, VisionOptions vision)
    : vehicle_(vehicle), vision_(std::move(vision)) {}

void TaskContext::look_with(VisionOptions vision) {
  vision_ = std::move(vision);
  trackers_.clear();
}

Result<const uav::SensorDescription*> TaskContext::sensor(std::string_view name) const {
  const uav::SensorDescription* sensor = vehicle_.catalogue().find_sensor(name);
  if (sensor == nullptr) return no_such("sensor", name, sensor_names(vehicle_.catalogue()));
  return sensor;
}

Result<const uav::SensorDescription*> TaskContext::sensor(std::string_view name,
                                                          uav::SensorKind kind) const {
  const uav::SensorDescription* sensor = vehicle_.catalogue().find_sensor(name);
  if (sensor == nullptr || sensor->kind() != kind)
    return no_such(uav::name(kind), name, sensor_names(vehicle_.catalogue(), kind));
  return sensor;
}

Result<const uav::SensorDescription*> TaskContext::camera() const {
  auto found = sensor(vision_.camera, uav::SensorKind::kCamera);
  if (!found || uav::has_color(*(*found)->camera_kind())) return found;
  return Failure{Failure::Kind::kInvalid, "the sensor \"" + vision_.camera + "\" is a " +
                                              std::string((*found)->kind_name()) +
                                              "; tracking needs a camera with colours"};
}

Result<const uav::Anchor*> TaskContext::anchor(std::string_view name) const {
  const uav::Anchor* anchor = vehicle_.catalogue().find_anchor(name);
  if (anchor == nullptr) return no_such("anchor", name, anchor_names(vehicle_.catalogue()));
  return anchor;
}

Result<vision::AnchorTracker*> TaskContext::tracker(std::string_view anchor_name) {
  if (const auto known = trackers_.find(anchor_name); known != trackers_.end()) {
    return &known->second;
  }
  const Result<const uav::Anchor*> anchor = this->anchor(anchor_name);
  if (!anchor) return anchor.failure();
  Result<vision::AnchorTracker> tracker = vision::AnchorTracker::create(**anchor, vision_.tracker);
  if (!tracker) return tracker.failure();
  return &trackers_.emplace(anchor_name, std::move(tracker).value()).first->second;
}

Result<uav::CameraSample> TaskContext::capture(const std::string& camera) {
  const client::Stage stage(vehicle_, "capture");
  return vehicle_.read<uav::CameraSample>(camera);
}

std::optional<vision::Roi> TaskContext::detect(vision::AnchorTracker& tracker,
                                               const uav::CameraSample& image) {
  const client::Stage stage(vehicle_, "detect");
  return tracker.track(image);
}

void TaskContext::note_event(std::string_view task, std::string_view phase, std::string_view event,
                             const Values& values) {
  json note = {{"task", task}, {"phase", phase}, {"event", event}};
  for (const auto& [key, value] : values) note[std::string(key)] = value;
  annotate(vehicle_, "task", note);
}

void TaskContext::note_end(std::string_view task, std::string_view status,
                           std::string_view reason) {
  annotate(vehicle_, "task",
           {{"task", task},
            {"phase", "finalise"},
            {"event", "end"},
            {"status", status},
            {"reason", reason}});
}

void TaskContext::note_mission(std::string_view task, std::string_view event,
                               std::string_view status, std::string_view reason) {
  json note = {{"task", task}, {"event", event}};
  if (!status.empty()) note["status"] = status;
  if (!reason.empty()) note["reason"] = reason;
  annotate(vehicle_, "mission", note);
}

void TaskContext::note_roi(const vision::Roi& roi, std::uint64_t image_index) {
  annotate(vehicle_, "roi",
           {{"camera", vision_.camera},
            {"u_px", roi.center.u_px},
            {"v_px", roi.center.v_px},
            {"width_px", roi.width_px},
            {"height_px", roi.height_px},
            {"angle_rad", roi.angle_rad},
            {"score", roi.score},
            {"image_index", image_index}});
}

void TaskContext::note_estimate(std::string_view anchor, std::uint64_t image_index,
                                const vision::RelativePosition& estimate, bool converged) {
  // JSON has no NaN: an unknown distance becomes null.
  annotate(vehicle_, "estimate",
           {{"anchor", anchor},
            {"camera", vision_.camera},
            {"image_index", image_index},
            {"bearing_rad", estimate.bearing_rad},
            {"distance_m", estimate.distance_m.value_or(std::numeric_limits<double>::quiet_NaN())},
            {"converged", converged}});
}

void TaskContext::note_odometry(const uav::Vec3& p_H0B, double yaw_rad) {
  annotate(vehicle_, "odometry", {{"x_m", p_H0B.x}, {"y_m", p_H0B.y}, {"yaw_rad", yaw_rad}});
}

void TaskContext::note_displacement(const uav::Vec3& p_H0B) {
  annotate(vehicle_, "displacement", {{"x_m", p_H0B.x}, {"y_m", p_H0B.y}});
}

}  // namespace tether::tasks
