#include "errors.h"
#include "handles.h"
#include "samples.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <vector>

using tether::client::Read;

namespace tether::c_api {
namespace {

std::optional<Read> from_c(tether_read_mode mode) {
  switch (mode) {
    case TETHER_READ_NEXT:
      return Read::kNext;
    case TETHER_READ_LATEST:
      return Read::kLatest;
    case TETHER_READ_IF_AVAILABLE:
      return Read::kIfAvailable;
    default:
      return std::nullopt;
  }
}

/// Reads a sensor and gives the sample to `take`, which returns a status.
template <class Sample, class Take>
tether_status read(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode, Take take) {
  const auto wanted = from_c(mode);
  if (!wanted) return fail(TETHER_INVALID, "unknown read mode; use one of TETHER_READ_...");
  return guarded([&] {
    auto sample = vehicle->vehicle->read<Sample>(sensor, *wanted);
    return sample ? take(std::move(*sample)) : fail(sample.failure());
  });
}

/// For samples that are a plain struct.
template <class Sample, class CStruct>
tether_status read_struct(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                          CStruct* out, std::size_t size) {
  if (!can_take(out, size) || !are_given(vehicle, sensor)) return TETHER_INVALID;
  return read<Sample>(vehicle, sensor, mode, [&](const Sample& sample) {
    put(to_c(sample), out, size);
    return TETHER_OK;
  });
}

/// Whether an image of that camera fits. A sensor that is none is told by the read.
tether_status check_capacity(const tether_vehicle& vehicle, const char* sensor,
                             std::size_t capacity) {
  const auto* found = vehicle.vehicle->catalogue().find_sensor(sensor);
  const auto* camera =
      found == nullptr ? nullptr : std::get_if<uav::CameraProperties>(&found->properties);
  if (camera == nullptr) return TETHER_OK;
  if (!uav::has_color(camera->kind)) {
    return guarded([&] {
      return fail(TETHER_INVALID, "'" + found->name + "' is a " +
                                      std::string(uav::name(camera->kind)) +
                                      ", which measures no colours; use tether_read_camera()");
    });
  }
  const std::size_t needed = std::size_t{3} * static_cast<std::size_t>(camera->model.width_px) *
                             static_cast<std::size_t>(camera->model.height_px);
  if (capacity >= needed) return TETHER_OK;
  return guarded([&] {
    return fail(TETHER_INVALID, "an image of '" + found->name + "' has " + std::to_string(needed) +
                                    " bytes; the buffer has " + std::to_string(capacity));
  });
}

/// Whether a scan of that lidar fits. A sensor that is none is told by the read.
bool fits_scan(const tether_vehicle& vehicle, const char* sensor, std::size_t capacity) {
  const auto* found = vehicle.vehicle->catalogue().find_sensor(sensor);
  const auto* scan =
      found == nullptr ? nullptr : std::get_if<uav::ScanProperties>(&found->properties);
  return scan == nullptr ||
         static_cast<std::size_t>(scan->columns) * static_cast<std::size_t>(scan->rows) <= capacity;
}

template <class T>
const T* pixels_of(const std::vector<T>& pixels) {
  return pixels.empty() ? nullptr : pixels.data();
}

}  // namespace
}  // namespace tether::c_api

using namespace tether::c_api;

namespace {

/// `intensities`: nullptr if they are not asked for.
tether_status read_scan(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                        float* ranges_m, float* intensities, size_t capacity,
                        tether_scan_info* info, size_t info_size) {
  if (info != nullptr && !can_take(info, info_size)) return TETHER_INVALID;
  if (!are_given(vehicle, sensor, ranges_m)) return TETHER_INVALID;
  if (!fits_scan(*vehicle, sensor, capacity))
    return fail(TETHER_INVALID, "a scan of this lidar has more rays than the buffer has room for");
  return read<tether::uav::ScanSample>(vehicle, sensor, mode, [&](const auto& sample) {
    if (sample.ranges_m.size() > capacity)
      return fail(TETHER_PROTOCOL, "the scan is larger than the lidar's");
    std::copy(sample.ranges_m.begin(), sample.ranges_m.end(), ranges_m);
    if (intensities != nullptr && sample.intensities.empty())
      std::fill_n(intensities, sample.ranges_m.size(), std::numeric_limits<float>::quiet_NaN());
    else if (intensities != nullptr)
      std::copy(sample.intensities.begin(), sample.intensities.end(), intensities);
    if (info != nullptr)
      put(tether_scan_info{tether::to_ns(sample.sampled_at), sample.index, sample.ranges_m.size()},
          info, info_size);
    return tether_status{TETHER_OK};
  });
}

}  // namespace

extern "C" {

tether_status tether_read_camera(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                 tether_image** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  if (!are_given(vehicle, sensor)) return TETHER_INVALID;
  return read<tether::uav::CameraSample>(vehicle, sensor, mode,
                                         [&](tether::uav::CameraSample sample) {
                                           *out = new tether_image(std::move(sample));
                                           return TETHER_OK;
                                         });
}

tether_status tether_set_queue(tether_vehicle* vehicle, const char* sensor,
                               uint32_t depth) noexcept {
  if (!are_given(vehicle, sensor)) return TETHER_INVALID;
  return guarded([&] { return status_of(vehicle->vehicle->set_queue(sensor, depth)); });
}

tether_status tether_read_together(tether_vehicle* vehicle, const char* const* cameras,
                                   size_t count, tether_image** out) noexcept {
  if (!are_given(out, cameras)) return TETHER_INVALID;
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = nullptr;
    if (!are_given(cameras[i])) return TETHER_INVALID;
  }
  if (!are_given(vehicle)) return TETHER_INVALID;
  if (count == 0) return fail(TETHER_INVALID, "no cameras are named");
  return guarded([&] {
    auto samples = tether::client::read_together<tether::uav::CameraSample>(
        *vehicle->vehicle, {cameras, cameras + count});
    if (!samples) return fail(samples.failure());
    // Made first, so that no image is lost when memory runs out.
    std::vector<std::unique_ptr<tether_image>> images;
    for (auto& sample : *samples)
      images.push_back(std::make_unique<tether_image>(std::move(sample)));
    for (std::size_t i = 0; i < count; ++i) out[i] = images[i].release();
    return tether_status{TETHER_OK};
  });
}

tether_status tether_image_copy(const tether_image* image, tether_image** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  if (!are_given(image)) return TETHER_INVALID;
  return guarded([&] {
    *out = new tether_image(tether::uav::CameraSample(*image->sample));
    return tether_status{TETHER_OK};
  });
}

void tether_image_free(tether_image* image) noexcept {
  delete image;
}

tether_status tether_image_get_info(const tether_image* image, tether_image_info* out,
                                    size_t size) noexcept {
  if (!can_take(out, size) || !are_given(image)) return TETHER_INVALID;
  put(to_c(*image->sample), out, size);
  return TETHER_OK;
}

const uint8_t* tether_image_rgb(const tether_image* image) noexcept {
  return are_given(image) ? pixels_of(image->sample->rgb) : nullptr;
}
const float* tether_image_depth_m(const tether_image* image) noexcept {
  return are_given(image) ? pixels_of(image->sample->depth_m) : nullptr;
}
const uint16_t* tether_image_labels(const tether_image* image) noexcept {
  return are_given(image) ? pixels_of(image->sample->labels) : nullptr;
}

tether_status tether_read_camera_into(tether_vehicle* vehicle, const char* sensor,
                                      tether_read_mode mode, uint8_t* rgb, size_t capacity,
                                      tether_image_info* info, size_t info_size) noexcept {
  if (info != nullptr && !can_take(info, info_size)) return TETHER_INVALID;
  if (!are_given(vehicle, sensor, rgb)) return TETHER_INVALID;
  if (const tether_status fits = check_capacity(*vehicle, sensor, capacity); fits != TETHER_OK)
    return fits;
  return read<tether::uav::CameraSample>(vehicle, sensor, mode, [&](const auto& sample) {
    if (sample.rgb.size() > capacity)
      return fail(TETHER_PROTOCOL, "the image is larger than the camera's");
    std::memcpy(rgb, sample.rgb.data(), sample.rgb.size());
    if (info != nullptr) put(to_c(sample), info, info_size);
    return tether_status{TETHER_OK};
  });
}

#define TETHER_READ(kind, Sample, size)                                                \
  tether_status tether_read_##kind(tether_vehicle* vehicle, const char* sensor,        \
                                   tether_read_mode mode, tether_##kind##_sample* out, \
                                   size_t out_size) noexcept {                         \
    return read_struct<tether::uav::Sample>(vehicle, sensor, mode, out, out_size);     \
  }
TETHER_SAMPLES(TETHER_READ)
#undef TETHER_READ

tether_status tether_read_scan(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                               float* ranges_m, size_t capacity, tether_scan_info* info,
                               size_t info_size) noexcept {
  return read_scan(vehicle, sensor, mode, ranges_m, nullptr, capacity, info, info_size);
}

tether_status tether_read_scan_intensities(tether_vehicle* vehicle, const char* sensor,
                                           tether_read_mode mode, float* ranges_m,
                                           float* intensities, size_t capacity,
                                           tether_scan_info* info, size_t info_size) noexcept {
  if (!are_given(intensities)) return TETHER_INVALID;
  return read_scan(vehicle, sensor, mode, ranges_m, intensities, capacity, info, info_size);
}

tether_status tether_read_battery(tether_vehicle* vehicle, tether_battery_sample* out,
                                  size_t size) noexcept {
  if (!can_take(out, size) || !are_given(vehicle)) return TETHER_INVALID;
  return guarded([&] {
    const auto sample = vehicle->vehicle->read_battery();
    if (sample) put(to_c(*sample, vehicle->vehicle->catalogue()), out, size);
    return status_of(sample);
  });
}

}  // extern "C"
