#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>

namespace tether::uav {

/// Where an anchor is seen in an image: the first and last column and row of its visible pixels.
struct SeenAnchor {
  std::string anchor;
  int left_px = 0, top_px = 0, right_px = 0, bottom_px = 0;
  std::int64_t pixels = 0;  ///< how many of the anchor are visible, > 0
  friend bool operator==(const SeenAnchor&, const SeenAnchor&) = default;
};

/// One image of a camera of any kind. Arrays that the camera's kind does not have are empty. All
/// are row-major from the top left.
struct CameraSample {
  SimTime sampled_at;       ///< time of the exposure [ST]
  std::uint64_t index = 0;  ///< number of this measurement of the sensor
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< height × width × 3 sRGB bytes R, G, B
  /// Height × width, along the optical axis [m]: +inf: nothing within range; −inf: closer than the
  /// minimum (REP-117, REP-118); NaN: the lens maps no direction to the pixel.
  std::vector<float> depth_m{};
  /// Height × width: label l shows CameraProperties::models[l − 1]; 0: none of them.
  std::vector<std::uint16_t> labels{};
  /// The truth, for the record only: no SUT receives it. The anchors that are seen in the image, in
  /// the world's order, if the back end knows them.
  bool knows_anchors = false;
  std::vector<SeenAnchor> seen_anchors{};
};

/// One measurement of the inertial measurement unit, in its own frame S.
struct ImuSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 angular_velocity_rad_s;  ///< w_WS in S
  Vec3 specific_force_m_s2;     ///< a − g in S: +9.81 along "up" when at rest
  Quat q_WS;  ///< attitude as the IMU's own filter reports it (yaw counter-clockwise from east)
};

/// One rangefinder measurement along the sensor's x axis.
struct RangeSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  double range_m = std::numeric_limits<double>::infinity();  ///< +inf: nothing within range; −inf:
                                                             ///< closer than the minimum (REP-117)
};

/// The battery at one instant.
struct BatterySample {
  SimTime sampled_at;
  double voltage_V = 0.0;  ///< at the terminals, under load
  double current_A = 0.0;  ///< drawn from it
  double charge = 0.0;     ///< share of the capacity that is left; [0, 1]
  friend bool operator==(const BatterySample&, const BatterySample&) = default;
};

/// In the order of SensorKind.
using Sample = std::variant<CameraSample, ImuSample, RangeSample, NavSatSample, MagnetometerSample,
                            BarometerSample, OdometrySample, ScanSample, JointStateSample>;
/// The kind of sensor that measures such samples.
template <class OneSample>
constexpr SensorKind kind_of() {
  return []<class... Samples>(std::type_identity<std::variant<Samples...>>) {
    int index = 0;
    (void)((std::is_same_v<Samples, OneSample> || (++index, false)) || ...);
    return static_cast<SensorKind>(index);
  }(std::type_identity<Sample>{});
}

SimTime sampled_at(const Sample& sample);

}  // namespace tether::uav
