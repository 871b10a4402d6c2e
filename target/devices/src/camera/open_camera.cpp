#include "camera/open_camera.h"

#include "camera/video4linux.h"
#include "camera/video_reader.h"

#include <algorithm>
#include <utility>
#include <variant>

// Opens a camera by the form of its name: a number or device node with Video4Linux, a file, or a
// URL. Live cameras must deliver one image at once, because some errors occur only then. On
// failure the driver is asked for the reason, which OpenCV does not report.
namespace tether::devices {
namespace {

constexpr int kStreamTimeoutMs = 10'000;

struct Camera {
  std::unique_ptr<CameraDevice> device;
  ImageFormat format;
};

struct Request {
  System& system;
  const Timeline& time;
  const std::string& label;
  const RigSensor& sensor;
  const VideoReader& videos;

  Failure refuse(const std::string& why) const {
    return {Failure::Kind::kInvalid, label + ": " + why};
  }
};

uav::CameraModel& model_of(RigSensor& sensor) {
  return std::get<uav::CameraProperties>(sensor.description.properties).model;
}

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_url(const std::string& text) {
  return text.find("://") != std::string::npos;
}

/// Reads an image, since some things go wrong with the first one only: a device that is busy, a
/// format that OpenCV cannot decode, a stream that says another size than it has.
Result<Camera> try_out(std::unique_ptr<LiveCamera> device) {
  const Result<uav::CameraSample> first = device->read(client::Read::kNext);
  if (!first) return first.failure();
  ImageFormat format = device->format();
  format.width_px = first->width_px;
  format.height_px = first->height_px;
  return Camera{std::move(device), format};
}

Result<Camera> open_device(const Request& request, const std::string& path) {
  const uav::SensorDescription& description = request.sensor.description;
  const auto& model = std::get<uav::CameraProperties>(description.properties).model;
  auto source =
      request.videos.open_device(path, {model.width_px, model.height_px, description.rate_hz});
  if (!source) return request.refuse(video4linux_fault(request.system, path));
  const auto why_stopped = [&system = request.system, path] {
    FileKind kind{};
    return system.stat(path, kind) < 0 ? std::string("the device was removed")
                                       : std::string("timed out: no image for 10 s; see `dmesg`");
  };
  Result<Camera> camera = try_out(std::make_unique<LiveCamera>(
      request.time, request.label, std::move(source), true, why_stopped));
  // The camera is closed by now, so that it is not ourselves who make it busy.
  if (!camera) return request.refuse(video4linux_fault(request.system, path));
  return camera;
}

Result<Camera> open_url(const Request& request, const std::string& url) {
  auto source = request.videos.open_stream(url, kStreamTimeoutMs);
  if (!source) {
    return request.refuse("timed out: OpenCV got no image from the stream for 10 s. `ffprobe " +
                          url + "` can show why");
  }
  Result<Camera> camera = try_out(std::make_unique<LiveCamera>(
      request.time, request.label, std::move(source), false,
      [] { return std::string("the stream ended, or sent no image for 10 s"); }));
  if (!camera) return Failure{Failure::Kind::kInvalid, camera.failure().message};
  return camera;
}

/// Looks through a source of its own, so that playing begins with the first image.
bool holds_image(const Request& request, const std::string& path) {
  const auto source = request.videos.open_file(path);
  uav::CameraSample first;
  return source && source->grab() && source->retrieve(first);
}

Result<Camera> open_file(const Request& request, const std::string& path) {
  auto source = request.videos.open_file(path);
  if (!source) {
    return request.refuse(
        "not a video file that OpenCV can read. Convert it, for example with `ffmpeg -i " + path +
        " -c:v mjpeg video.avi`");
  }
  if (!holds_image(request, path)) {
    return request.refuse("has no readable image; the file is possibly truncated. Record it again");
  }
  const ImageFormat format = source->format();
  auto video = PlayedVideo::create(request.time, request.label, std::move(source), path);
  if (!video) return video.failure();
  return Camera{std::move(*video), format};
}

Result<Camera> open_path(const Request& request, const std::string& path) {
  FileKind kind{};
  const int status = request.system.stat(path, kind);
  if (status < 0) {
    return request.refuse(error_text(-status) + "; `v4l2-ctl --list-devices` lists the cameras");
  }
  switch (kind) {
    case FileKind::kCharacterDevice:
      return open_device(request, path);
    case FileKind::kRegular:
      return open_file(request, path);
    default:
      return request.refuse("neither a video device nor a video file");
  }
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px);
}

/// Fills in what the description leaves open; its size, if it has one, must be the device's.
Status complete(const Request& request, const ImageFormat& format, RigSensor& sensor) {
  uav::CameraModel& model = model_of(sensor);
  const int width_px = format.width_px;
  const int height_px = format.height_px;
  if (model.width_px == 0) {
    const uav::CameraModel centred =
        uav::CameraModel::from_horizontal_fov(width_px, height_px, sensor.horizontal_fov_rad);
    model.width_px = width_px;
    model.height_px = height_px;
    model.cx_px = centred.cx_px;
    model.cy_px = centred.cy_px;
    if (sensor.horizontal_fov_rad > 0.0) {
      model.fx_px = centred.fx_px;
      model.fy_px = centred.fy_px;
    }
  }
  if (model.width_px != width_px || model.height_px != height_px) {
    return request.refuse("its images have " + size_text(width_px, height_px) +
                          " px, but the rig file has " +
                          size_text(model.width_px, model.height_px) +
                          ". Correct size_px and the calibration in the rig file");
  }
  double& rate_hz = sensor.description.rate_hz;
  if (rate_hz <= 0.0) rate_hz = format.rate_hz;
  return ok_status();
}

}  // namespace

Result<std::unique_ptr<CameraDevice>> open_camera(System& system, const Timeline& time,
                                                  const std::string& label, RigSensor& sensor) {
  const Result<const VideoReader*> videos = video_reader();
  if (!videos) return Failure{videos.failure().kind, label + ": " + videos.failure().message};
  const Request request{system, time, label, sensor, **videos};
  const std::string path = is_number(sensor.device) ? "/dev/video" + sensor.device : sensor.device;
  Result<Camera> camera = is_url(path) ? open_url(request, path) : open_path(request, path);
  if (!camera) return camera.failure();
  if (const Status good = complete(request, camera->format, sensor); !good) return good.failure();
  return std::move(camera->device);
}

}  // namespace tether::devices
