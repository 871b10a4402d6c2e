#include "fuzz_target.h"

#include <cmath>

#include <tether/sim/world.h>

/// SDF to the scene that back ends get. Input: a world's file where it has a <world>, else a UAV's;
/// it may include the other files of its folder.
namespace tether::fuzz {
namespace {

constexpr const char* kWorld = "<sdf version='1.7'><world name='w'/></sdf>";
constexpr const char* kBox = R"(<sdf version='1.7'><model name='box'><link name='link'>
<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>
</link></model></sdf>)";

bool is_finite(const uav::Pose& X) {
  double sum = 0.0;
  for (const double x : {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z}) sum += std::abs(x);
  return std::isfinite(sum);
}

void require_whole(const sim::Link& link) {
  require(link.mass_kg > 0.0 && std::isfinite(link.mass_kg), "a bad mass");
  require(is_finite(link.X_ML) && is_finite(link.X_LI), "a link that is nowhere");
  for (const sim::Visual& visual : link.visuals) require(is_finite(visual.X_LV), "nowhere");
  for (const sim::Collision& collision : link.collisions)
    require(is_finite(collision.X_LC) && std::isfinite(collision.friction), "nowhere");
}

/// What world.h promises.
void require_whole(const sim::World& world) {
  require(world.step > Duration(0) && std::isfinite(world.gravity_m_s2), "a bad step or gravity");
  for (const sim::Model& model : world.models) {
    require(is_finite(model.X_WM), "a model that is nowhere");
    for (const sim::Link& link : model.links) require_whole(link);
  }
  for (const sim::Light& light : world.lights) require(is_finite(light.X_WL), "nowhere");
  for (const sim::Uav& uav : world.uavs) {
    require_whole(uav.body);
    require(!uav.airframe.rotors.empty(), "a multirotor without rotors");
    for (const sim::Sensor& sensor : uav.sensors) require(is_finite(sensor.X_BS), "nowhere");
    (void)sim::make_catalogue(world, uav);
  }
  for (const auto& file : world.files)
    require(std::filesystem::is_regular_file(file), "a file that is not there");
}

sim::WorldRequest request(const InputFolder& folder, Bytes input) {
  const std::string text = text_of(input);
  if (text.find("<world") != std::string::npos) return {folder.write("input.sdf", text), {}, {}};
  return {folder.path() / "world.sdf", {{"uav", folder.write("input.sdf", text), {}, 0.5}}, {}};
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  static const auto written = {folder.write("world.sdf", std::string_view(fuzz::kWorld)),
                               folder.write("models/box/model.sdf", std::string_view(fuzz::kBox))};
  (void)written;
  const sim::WorldRequest request = fuzz::request(folder, {data, size});
  const auto read = fuzz::read_or_refuse([&] {
    return sim::load_world(request, [](const std::string& line) { fuzz::require_one_line(line); });
  });
  if (read) fuzz::require_whole(*read);
  return 0;
}
