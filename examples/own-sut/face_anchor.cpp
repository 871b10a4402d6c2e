// Turns the UAV towards an anchor: the "face anchor" task in plain C++17, with only Tether's client
// library.
//
// usage: face_anchor_cpp ANCHOR
//
// `tether run` starts it (see face_anchor.toml). Exit code: 0 if it faces the anchor, 1 if it does
// not, 2 for wrong use, 3 if the connection failed.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include <tether/client.hpp>

namespace {

namespace api = tether::api;
using namespace std::chrono_literals;

constexpr double kPi = 3.14159265358979323846;
constexpr double kPrecision_rad = 2.0 * kPi / 180.0;
constexpr double kFastest_rad_s = 25.0 * kPi / 180.0;
constexpr double kGain_per_s = 1.2;
constexpr int kImagesInARow = 3;
constexpr auto kTimeLimit = 40s;  // execution time, like every time here

// Light and shade change the brightness of a surface, but hardly its colour. A pixel belongs to the
// anchor if its vector in the colour space has the anchor's direction, and if it is not too dark.
bool has_color(const std::uint8_t* rgb, const api::Vec3& color) {
  const double r = rgb[0], g = rgb[1], b = rgb[2];
  const double dot = r * color.x + g * color.y + b * color.z;
  const double pixel = r * r + g * g + b * b;
  const double wanted = color.x * color.x + color.y * color.y + color.z * color.z;
  return pixel > 50.0 * 50.0 && dot * dot > 0.9 * pixel * wanted;
}

// Mean column of the anchor's pixels; none if there are too few pixels.
std::optional<double> find_column(const api::Image& image, const api::Vec3& color) {
  double sum = 0.0;
  int count = 0;
  for (int v = 0; v < image.height_px(); ++v)
    for (int u = 0; u < image.width_px(); ++u)
      if (has_color(image.pixel(u, v), color)) {
        sum += u;
        ++count;
      }
  if (count < image.width_px() * image.height_px() / 5000) return std::nullopt;
  return sum / count;
}

// Angle of a column's viewing direction [rad], positive to the left, for a lens without distortion.
double bearing_of(double u_px, const api::CameraModel& lens) {
  return std::atan((lens.cx_px - u_px) / lens.fx_px);
}

void tell(api::Vehicle& vehicle, const char* anchor, const api::Image& image, double bearing_rad,
          bool converged) {
  char json[256];
  std::snprintf(json, sizeof json,
                R"({"anchor": "%s", "camera": "camera", "image_index": %llu, "bearing_rad": %.6f, )"
                R"("distance_m": null, "converged": %s})",
                anchor, static_cast<unsigned long long>(image.index()), bearing_rad,
                converged ? "true" : "false");
  // A failed annotation need not stop the flight; the next call reports a lost connection.
  (void)vehicle.annotate("estimate", json);
}

// Turns until the UAV faces the anchor (true) or the time limit is reached (false). Fails if the
// vehicle is lost.
api::Result<bool> face(api::Vehicle& vehicle, const api::Anchor& anchor,
                       const api::CameraModel& lens) {
  const api::ExecTime begin = vehicle.now();
  double yaw_rate_rad_s = kFastest_rad_s;  // turns left until it sees the anchor
  int in_a_row = 0;
  while (in_a_row < kImagesInARow) {
    if (vehicle.now() - begin > kTimeLimit) return false;
    const auto image = vehicle.read_camera("camera");
    if (!image) return image.failure();
    if (const auto u_px = find_column(*image, anchor.color())) {
      const double bearing_rad = bearing_of(*u_px, lens);
      in_a_row = std::abs(bearing_rad) <= kPrecision_rad ? in_a_row + 1 : 0;
      yaw_rate_rad_s = std::clamp(kGain_per_s * bearing_rad, -kFastest_rad_s, kFastest_rad_s);
      tell(vehicle, anchor.name(), *image, bearing_rad, in_a_row == kImagesInARow);
    }
    if (const auto turned = vehicle.command_velocity({}, yaw_rate_rad_s); !turned)
      return turned.failure();
  }
  if (const auto stopped = vehicle.command_velocity({}, 0.0); !stopped) return stopped.failure();
  if (const auto rested = vehicle.sleep_for(500ms); !rested) return rested.failure();
  return true;
}

int fail(const api::Failure& failure) {
  std::fprintf(stderr, "face_anchor_cpp: %s\n", failure.message());
  return 3;
}

// Ends the run with a reason. The exit code is 2, because the user must correct the scenario.
int give_up(api::Vehicle& vehicle, const char* why) {
  std::fprintf(stderr, "face_anchor_cpp: %s\n", why);
  (void)vehicle.finish(false, why);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: face_anchor_cpp ANCHOR\n");
    return 2;
  }
  auto vehicle = api::connect();
  if (!vehicle) return fail(vehicle.failure());

  const auto anchor = vehicle->find_anchor(argv[1]);
  if (!anchor) return give_up(*vehicle, "there is no such anchor");
  const auto camera = vehicle->find_sensor("camera");
  if (!camera) return give_up(*vehicle, "the UAV has no sensor named camera");
  const auto lens = camera->camera_model();
  if (!lens) return give_up(*vehicle, lens.failure().message());

  const auto faced = face(*vehicle, *anchor, *lens);
  if (!faced) return fail(faced.failure());
  const auto finished = vehicle->finish(*faced, *faced ? "faces the anchor" : "time limit");
  if (!finished) return fail(finished.failure());
  return *faced ? 0 : 1;
}
