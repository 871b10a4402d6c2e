#include "frames.h"

#include "embedded_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include <turbojpeg.h>

#include <tether/base/random.h>
#include <tether/base/units.h>

namespace tether::calibration {
namespace {

constexpr int kWidth_px = 640, kHeight_px = 480;

/// Ones among 16 random bits, about 8 with a standard deviation of 2: the camera's noise, of 0.007
/// of full scale, in whole numbers alone, so that no machine rounds otherwise.
int noise(std::uint32_t bits) {
  int ones = -8;
  for (std::uint32_t rest = bits & 0xFFFFU; rest != 0; rest &= rest - 1) ++ones;
  return ones;
}

void add_noise(std::vector<std::uint8_t>& rgb, std::uint64_t frame) {
  KeyedRandom random(
      {.seed = 1, .stream = random_stream("calibrate", "camera", "noise"), .index = frame});
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    bits = i % 2 == 0 ? random.bits() : bits >> 16;
    rgb[i] = static_cast<std::uint8_t>(std::clamp(rgb[i] + noise(bits), 0, 255));
  }
}

Result<uav::CameraSample> read_frame(std::size_t number) {
  const EmbeddedFile& file = kEmbeddedFrames[number];
  uav::CameraSample sample;
  sample.index = number;
  sample.width_px = kWidth_px;
  sample.height_px = kHeight_px;
  sample.rgb.resize(std::size_t{3} * kWidth_px * kHeight_px);
  const std::unique_ptr<void, decltype(&tjDestroy)> reader(tjInitDecompress(), &tjDestroy);
  if (tjDecompress2(reader.get(), file.bytes, file.size, sample.rgb.data(), kWidth_px, 0,
                    kHeight_px, TJPF_RGB, TJFLAG_ACCURATEDCT) != 0) {
    return Failure{Failure::Kind::kInvalid, std::string("cannot decode a calibration image: ") +
                                                tjGetErrorStr2(reader.get())};
  }
  add_noise(sample.rgb, number);
  return sample;
}

}  // namespace

Result<std::vector<uav::CameraSample>> calibration_frames() {
  std::vector<uav::CameraSample> frames;
  for (std::size_t i = 0; i < kEmbeddedFrameCount; ++i) {
    Result<uav::CameraSample> frame = read_frame(i);
    if (!frame) return frame.failure();
    frames.push_back(std::move(frame).value());
  }
  return frames;
}

uav::SensorDescription calibration_camera() {
  uav::SensorDescription camera;
  camera.name = "camera";
  camera.X_BS.p = {0.10, 0.0, 0.0};
  camera.properties = uav::CameraProperties{
      uav::CameraModel::from_horizontal_fov(kWidth_px, kHeight_px, 1.3962634)};
  return camera;
}

uav::Anchor calibration_anchor() {
  return {"blue_box", uav::AnchorShape::kBox, {0.4, 0.4, 0.4}, {0.05, 0.15, 0.85}};
}

const std::vector<View>& expected_views() {
  static const std::vector<View> kViews = {
      {98.9995, 239.1546, 50.7564, 42.0752, 29.9540, 4.4198},
      {116.4889, 239.1598, 49.7092, 41.2535, 27.9493, 4.3524},
      {134.0516, 239.1914, 46.7387, 40.3835, 25.8644, 4.4216},
      {150.4919, 239.3834, 45.7937, 39.3739, 23.8377, 4.4195},
      {166.5592, 239.3497, 43.7093, 39.4030, 21.7968, 4.3473},
      {182.0068, 239.2931, 42.6230, 39.1391, 19.7755, 4.3003},
  };
  return kViews;
}

}  // namespace tether::calibration
