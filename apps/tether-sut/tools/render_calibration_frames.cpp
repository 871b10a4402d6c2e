// Makes the images of `tether-sut calibrate`: the face-anchor scenario's camera while the UAV turns
// towards the anchor, without the camera's noise, which would not compress and is added as they are
// read.
//
//   render_calibration_frames SOURCES FOLDER
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <tether/base/error.h>
#include <tether/base/units.h>
#include <tether/sim/world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sdf/load_world.h>

namespace {

namespace sim = tether::sim;
namespace uav = tether::uav;
using tether::Error;
using tether::ErrorCode;

/// Steps in which the tracker can follow.
constexpr double kYaws_deg[] = {-24.0, -22.0, -20.0, -18.0, -16.0, -14.0};

uav::CameraSample render(const std::filesystem::path& sources, double yaw_deg) {
  const sim::WorldRequest request{.world = sources / "data/worlds/room.sdf",
                                  .uavs = {{"uav1",
                                            sources / "data/models/hummingbird/model.sdf",
                                            {1.2, 0.0, 1.2},
                                            tether::rad_from_deg(yaw_deg)}},
                                  .anchors = {"blue_box"}};
  sim::World world = sim::load_world(request, {});
  auto& sensors = world.uavs.front().sensors;
  std::size_t camera = 0;
  while (sensors.at(camera).kind() != uav::SensorKind::kCamera) ++camera;
  std::get<sim::CameraModel>(sensors[camera].model).pixel_noise = {};
  const auto simulator = sim::make_mujoco_simulator(std::move(world), {});
  sim::Snapshot snapshot;
  simulator->capture(snapshot);
  return std::get<uav::CameraSample>(simulator->measure(snapshot, 0, camera, 0));
}

void write(const std::filesystem::path& file, uav::CameraSample image) {
  const cv::Mat rgb(image.height_px, image.width_px, CV_8UC3, image.rgb.data());
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  if (!cv::imwrite(file.string(), bgr, {cv::IMWRITE_JPEG_QUALITY, 90}))
    throw Error(ErrorCode::kSetup, file.string() + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: render_calibration_frames SOURCES FOLDER\n";
    return 2;
  }
  try {
    int number = 0;
    for (const double yaw_deg : kYaws_deg)
      write(std::filesystem::path(argv[2]) / ("frame" + std::to_string(++number) + ".jpg"),
            render(argv[1], yaw_deg));
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return exit_code(error.code());
  }
}
