#include "bench.h"

#include "files.h"

#include <cmath>
#include <stdexcept>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <tether/sim/world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::system_test {
namespace {

constexpr double kFrameRate_hz = 30.0;

std::unique_ptr<sim::Simulator> make_simulator() {
  const std::filesystem::path sources = TETHER_SOURCE_DIR;
  const sim::WorldRequest request{
      .world = sources / "data/worlds/room.sdf",
      .uavs = {{"uav1", sources / "data/models/hummingbird/model.sdf", {2.6, 0.4, 1.2}, 0.0}},
      .anchors = {"blue_box"}};
  auto simulator = sim::make_mujoco_simulator(sim::load_world(request, {}), {});
  simulator->reset(1);
  return simulator;
}

std::size_t sensor_index(const sim::Simulator& simulator, const std::string& name) {
  const auto& sensors = simulator.world().uavs.front().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i].name == name) return i;
  throw std::logic_error("no sensor " + name);
}

cv::Mat to_bgr(uav::CameraSample& sample) {
  const cv::Mat rgb(sample.height_px, sample.width_px, CV_8UC3, sample.rgb.data());
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

void write_video(sim::Simulator& simulator, const std::filesystem::path& file, int frames) {
  const std::size_t camera = sensor_index(simulator, "camera");
  cv::VideoWriter writer(file.string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kFrameRate_hz, {640, 480});
  if (!writer.isOpened()) throw std::runtime_error("cannot write " + file.string());
  sim::Snapshot snapshot;
  for (int i = 0; i < frames; ++i) {
    simulator.advance_to(simulator.now() + std::chrono::milliseconds(33));
    simulator.capture(snapshot);
    auto sample = simulator.measure(snapshot, 0, camera, static_cast<std::uint64_t>(i));
    writer.write(to_bgr(std::get<uav::CameraSample>(sample)));
  }
}

}  // namespace

void write_range_folder(const std::filesystem::path& folder, int range_mm) {
  std::filesystem::create_directories(folder);
  write_text(folder / "name", "vl53l0x\n");
  write_text(folder / "in_distance_raw", std::to_string(range_mm) + "\n");
  write_text(folder / "in_distance_scale", "0.001000\n");
}

Bench make_bench(const std::filesystem::path& folder, int frames) {
  const auto simulator = make_simulator();
  Bench bench{folder / "clip.avi", folder / "iio:device0", 0.0};
  write_video(*simulator, bench.video, frames);

  sim::Snapshot snapshot;
  simulator->capture(snapshot);
  const auto range = std::get<uav::RangeSample>(
      simulator->measure(snapshot, 0, sensor_index(*simulator, "range"), 0));
  write_range_folder(bench.range, static_cast<int>(std::lround(1e3 * range.range_m)));
  const auto& anchor = simulator->world().anchors.front();
  bench.distance_m = anchor.X_WA.p.x - simulator->ground_truth(0).body.p_WB.x - 0.10;
  return bench;
}

}  // namespace tether::system_test
