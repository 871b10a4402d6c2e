#include "errors.h"
#include "handles.h"
#include "samples.h"

#include <variant>

using tether::c_api::are_given;
using tether::c_api::fail;
using tether::c_api::to_c;
using tether::uav::Anchor;
using tether::uav::CameraProperties;
using tether::uav::SensorDescription;

/// `tether_sensor` and `tether_anchor` have no definition: pointers to them are pointers to what
/// the catalogue holds.
namespace {

const SensorDescription* from_c(const tether_sensor* sensor) {
  return reinterpret_cast<const SensorDescription*>(sensor);
}
const tether_sensor* to_c(const SensorDescription* sensor) {
  return reinterpret_cast<const tether_sensor*>(sensor);
}
const Anchor* from_c(const tether_anchor* anchor) {
  return reinterpret_cast<const Anchor*>(anchor);
}
const tether_anchor* to_c(const Anchor* anchor) {
  return reinterpret_cast<const tether_anchor*>(anchor);
}

tether_camera_model to_c(const tether::uav::CameraModel& m) {
  return {m.width_px, m.height_px, m.fx_px, m.fy_px, m.cx_px, m.cy_px,
          m.k1,       m.k2,        m.p1,    m.p2,    m.k3};
}

}  // namespace

extern "C" {

const char* tether_uav_name(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? vehicle->vehicle->catalogue().uav.c_str() : "";
}

// ---- Sensors ------------------------------------------------------------------------------------

size_t tether_sensor_count(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? vehicle->vehicle->catalogue().sensors.size() : 0;
}

const tether_sensor* tether_sensor_at(const tether_vehicle* vehicle, size_t index) noexcept {
  if (index >= tether_sensor_count(vehicle)) return nullptr;
  return to_c(&vehicle->vehicle->catalogue().sensors[index]);
}

const tether_sensor* tether_find_sensor(const tether_vehicle* vehicle, const char* name) noexcept {
  if (!are_given(vehicle, name)) return nullptr;
  return to_c(vehicle->vehicle->catalogue().find_sensor(name));
}

const char* tether_sensor_name(const tether_sensor* sensor) noexcept {
  return are_given(sensor) ? from_c(sensor)->name.c_str() : "";
}

tether_sensor_kind tether_sensor_get_kind(const tether_sensor* sensor) noexcept {
  if (!are_given(sensor)) return -1;
  // The other kinds of cameras came between the first three kinds and the later ones.
  constexpr tether_sensor_kind kCameras = TETHER_SEGMENTATION_CAMERA - TETHER_RANGE;
  const auto kind = static_cast<tether_sensor_kind>(from_c(sensor)->kind());
  const auto of_camera = from_c(sensor)->camera_kind();
  if (of_camera && *of_camera != tether::uav::CameraKind::kColor)
    return TETHER_RANGE + static_cast<tether_sensor_kind>(*of_camera);
  return kind > TETHER_RANGE ? kind + kCameras : kind;
}

double tether_sensor_rate_hz(const tether_sensor* sensor) noexcept {
  return are_given(sensor) ? from_c(sensor)->rate_hz : 0.0;
}

tether_status tether_sensor_mounting(const tether_sensor* sensor, tether_pose* out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = {};
  if (!are_given(sensor)) return TETHER_INVALID;
  *out = {to_c(from_c(sensor)->X_BS.p), to_c(from_c(sensor)->X_BS.q)};
  return TETHER_OK;
}

size_t tether_sensor_joints(const tether_sensor* sensor) noexcept {
  return are_given(sensor) ? from_c(sensor)->joints : 0;
}

tether_status tether_sensor_camera_model(const tether_sensor* sensor, tether_camera_model* out,
                                         size_t size) noexcept {
  if (!tether::c_api::can_take(out, size) || !are_given(sensor)) return TETHER_INVALID;
  const auto* camera = std::get_if<CameraProperties>(&from_c(sensor)->properties);
  if (camera == nullptr) return fail(TETHER_INVALID, "the sensor is not a camera");
  tether::c_api::put(to_c(camera->model), out, size);
  return TETHER_OK;
}

tether_status tether_sensor_range_limits(const tether_sensor* sensor, double* min_m,
                                         double* max_m) noexcept {
  if (!are_given(min_m, max_m)) return TETHER_INVALID;
  *min_m = *max_m = 0.0;
  if (!are_given(sensor)) return TETHER_INVALID;
  const auto give = [&](const auto& limits) {
    *min_m = limits.min_m;
    *max_m = limits.max_m;
    return tether_status{TETHER_OK};
  };
  const auto& properties = from_c(sensor)->properties;
  if (const auto* range = std::get_if<tether::uav::RangeProperties>(&properties))
    return give(*range);
  const auto* camera = std::get_if<CameraProperties>(&properties);
  if (camera != nullptr && tether::uav::has_depth(camera->kind)) return give(*camera);
  return fail(TETHER_INVALID, "the sensor measures no distances");
}

tether_status tether_sensor_scan_model(const tether_sensor* sensor, tether_scan_model* out,
                                       size_t size) noexcept {
  if (!tether::c_api::can_take(out, size) || !are_given(sensor)) return TETHER_INVALID;
  const auto* scan = std::get_if<tether::uav::ScanProperties>(&from_c(sensor)->properties);
  if (scan == nullptr) return fail(TETHER_INVALID, "the sensor is not a lidar");
  tether::c_api::put(
      tether_scan_model{scan->columns, scan->rows, scan->min_azimuth_rad, scan->max_azimuth_rad,
                        scan->min_elevation_rad, scan->max_elevation_rad, scan->min_m, scan->max_m,
                        scan->sweep_s},
      out, size);
  return TETHER_OK;
}

const char* tether_sensor_label_model(const tether_sensor* sensor, uint16_t label) noexcept {
  if (!are_given(sensor)) return nullptr;
  const auto* camera = std::get_if<CameraProperties>(&from_c(sensor)->properties);
  if (camera == nullptr || label == 0 || label > camera->models.size()) return nullptr;
  return camera->models[label - std::size_t{1}].c_str();
}

// ---- Anchors ------------------------------------------------------------------------------------

size_t tether_anchor_count(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? vehicle->vehicle->catalogue().anchors.size() : 0;
}

const tether_anchor* tether_anchor_at(const tether_vehicle* vehicle, size_t index) noexcept {
  if (index >= tether_anchor_count(vehicle)) return nullptr;
  return to_c(&vehicle->vehicle->catalogue().anchors[index]);
}

const tether_anchor* tether_find_anchor(const tether_vehicle* vehicle, const char* name) noexcept {
  if (!are_given(vehicle, name)) return nullptr;
  return to_c(vehicle->vehicle->catalogue().find_anchor(name));
}

const char* tether_anchor_name(const tether_anchor* anchor) noexcept {
  return are_given(anchor) ? from_c(anchor)->name.c_str() : "";
}

tether_anchor_shape tether_anchor_get_shape(const tether_anchor* anchor) noexcept {
  return are_given(anchor) ? static_cast<tether_anchor_shape>(from_c(anchor)->shape) : -1;
}

tether_status tether_anchor_size(const tether_anchor* anchor, tether_vec3* out_m) noexcept {
  if (!are_given(out_m)) return TETHER_INVALID;
  *out_m = {};
  if (!are_given(anchor)) return TETHER_INVALID;
  *out_m = to_c(from_c(anchor)->size_m);
  return TETHER_OK;
}

tether_status tether_anchor_color(const tether_anchor* anchor, tether_vec3* out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = {};
  if (!are_given(anchor)) return TETHER_INVALID;
  *out = to_c(from_c(anchor)->color_rgb);
  return TETHER_OK;
}

}  // extern "C"
