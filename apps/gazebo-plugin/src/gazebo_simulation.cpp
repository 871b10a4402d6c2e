// Gazebo's world as the Simulation of a Session. `open` inserts the UAVs; `is_ready` waits until
// Gazebo has made models and visuals, in steps without physics; drawing happens in the main thread.

#include "gazebo_simulation.h"

#include "conversions.h"
#include "scene.h"

#include <thread>

#include <gazebo/gazebo_config.h>
#include <gazebo/physics/ode/ODELink.hh>
#include <gazebo/physics/ode/ODEPhysics.hh>
#include <gazebo/physics/physics.hh>
#include <gazebo/rendering/rendering.hh>
#include <ignition/math/Rand.hh>

#include <tether/base/error.h>
#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

// Time limit for models and visuals to appear.
constexpr std::chrono::seconds kWarmUpLimit{40};
constexpr std::chrono::milliseconds kWarmUpPause{1};

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::kSetup, what);
}

TouchedPoint::Side side_of(const ::gazebo::physics::Collision& collision, const OdeBodies& bodies) {
  const auto* link = dynamic_cast<const ::gazebo::physics::ODELink*>(collision.GetLink().get());
  const dBodyID id = link ? link->GetODEId() : nullptr;
  return {bodies.find(id), collision.GetModel()->GetScopedName(), collision.GetId()};
}

bool can_draw() {
  using ::gazebo::rendering::RenderEngine;
  return RenderEngine::Instance()->GetRenderPathType() != RenderEngine::NONE;
}

}  // namespace

GazeboSimulation::GazeboSimulation(::gazebo::physics::WorldPtr world, MainThread& main_thread,
                                   std::function<bool()> give_up)
    : world_(std::move(world)), main_thread_(main_thread), give_up_(std::move(give_up)) {}

GazeboSimulation::~GazeboSimulation() = default;

void GazeboSimulation::check(const protocol::Open& open) const {
  if (open.world_name != world_->Name()) {
    fail("Gazebo has the world '" + world_->Name() + "', the scenario '" + open.world_name +
         "': start gzserver with " + open.world_file);
  }
  if (world_->Physics()->GetType() != "ode") {
    fail(open.world_file + ": Gazebo uses the physics '" + world_->Physics()->GetType() +
         "', but Tether's plugin requires ODE; write <physics type=\"ode\">");
  }
  for (const protocol::UavDescription& uav : open.uavs) {
    if (!world_->ModelByName(uav.name)) continue;
    fail("the world already has a model '" + uav.name + "'; give the UAV another name");
  }
  if (open.max_width_px > 0 && !can_draw()) {
    fail(
        "no OpenGL: Gazebo cannot draw camera images; set DISPLAY to an X server with OpenGL, such "
        "as Xvfb");
  }
}

void GazeboSimulation::open(const protocol::Open& open) {
  check(open);
  open_ = open;
  // Contacts are kept although nobody subscribes to them.
  world_->Physics()->GetContactManager()->SetNeverDropContacts(true);
  world_->Physics()->SetMaxStepSize(to_seconds(open.step));
  world_->Physics()->SetRealTimeUpdateRate(0.0);
  world_->SetGravity({0.0, 0.0, -open.gravity_m_s2});
  // Nothing moves before ST 0.
  world_->SetPhysicsEnabled(false);
  bool draws = open.max_width_px > 0;
  for (const protocol::UavDescription& uav : open.uavs) {
    world_->InsertModelString(draws ? with_idle_camera(uav.sdf) : uav.sdf);
    draws = false;
  }
  deadline_ = Clock::now() + kWarmUpLimit;
}

bool GazeboSimulation::is_ready() {
  std::this_thread::sleep_for(kWarmUpPause);
  if (must_wait_for(missing_models())) return false;
  if (open_.max_width_px > 0 && !pictures_) {
    if (must_wait_for(missing_visuals())) return false;
    if (!prepare_pictures() && must_wait_for({"the pictures"})) return false;
  }
  bodies_ = OdeBodies(world_, open_);
  rays_.emplace(world_, bodies_);
  const auto ode = boost::dynamic_pointer_cast<::gazebo::physics::ODEPhysics>(world_->Physics());
  order_ = SpaceOrder(ode->GetSpaceId());
  world_->SetPhysicsEnabled(true);
  return true;
}

bool GazeboSimulation::must_wait_for(const std::vector<std::string>& missing) const {
  if (missing.empty()) return false;
  if (Clock::now() < deadline_) return true;
  const std::size_t others = missing.size() - 1;
  fail("Gazebo has not made '" + missing.front() + "'" +
       (others > 0 ? " and " + std::to_string(others) + " more" : "") + " within " +
       std::to_string(kWarmUpLimit.count()) + " s; see the output of gzserver");
}

std::vector<std::string> GazeboSimulation::missing_models() const {
  std::vector<std::string> missing;
  for (const protocol::UavDescription& uav : open_.uavs) {
    if (!world_->ModelByName(uav.name)) missing.push_back(uav.name);
  }
  return missing;
}

std::vector<std::string> GazeboSimulation::missing_visuals() {
  const std::vector<std::string> expected = expected_visuals(world_);
  std::vector<std::string> missing = {"the scene"};
  warm_up_in_main_thread([&] {
    const auto scene = complete_scene(world_->Name());
    if (scene) missing = gazebo_plugin::missing_visuals(scene, expected);
    if (scene && scene->LightCount() < world_->LightCount()) missing.emplace_back("a light");
  });
  return missing;
}

bool GazeboSimulation::prepare_pictures() {
  std::vector<std::string> names;
  for (const auto& uav : open_.uavs) names.push_back(uav.name + "::base_link");
  for (const auto& body : open_.bodies) names.push_back(body.model + "::" + body.link);
  return warm_up_in_main_thread([&] {
    const auto scene = complete_scene(world_->Name());
    apply_materials(scene, open_.materials);
    pictures_ = std::make_unique<Pictures>(scene, names, open_.max_width_px, open_.max_height_px);
  });
}

std::string GazeboSimulation::description() const {
  return std::string("Gazebo ") + GAZEBO_VERSION_FULL + ", ODE";
}

void GazeboSimulation::reset(std::uint64_t seed) {
  const auto short_seed = static_cast<std::uint32_t>(seed ^ (seed >> 32U));
  ignition::math::Rand::Seed(short_seed);
  world_->Reset();
  // Gazebo counts a step at its beginning, and this one has begun.
  world_->SetSimTime(::gazebo::common::Time(to_seconds(open_.step)));
  world_->Physics()->SetSeed(short_seed);
  bodies_.reset();
  order_.restore();
}

std::vector<uav::BodyState> GazeboSimulation::bodies() const {
  std::vector<uav::BodyState> states;
  for (std::size_t i = 0; i < bodies_.size(); ++i) states.push_back(bodies_.state(i));
  return states;
}

void GazeboSimulation::push(std::size_t uav, const uav::Vec3& force_W, const uav::Vec3& torque_W) {
  bodies_.push(uav, force_W, torque_W);
}

// Gazebo keeps the contacts of a step until the next one.
std::vector<TouchedPoint> GazeboSimulation::touched_points() const {
  const auto* manager = world_->Physics()->GetContactManager();
  std::vector<TouchedPoint> points;
  for (unsigned int i = 0; i < manager->GetContactCount(); ++i) {
    const ::gazebo::physics::Contact& contact = *manager->GetContacts()[i];
    const TouchedPoint::Side first = side_of(*contact.collision1, bodies_);
    const TouchedPoint::Side second = side_of(*contact.collision2, bodies_);
    for (int k = 0; k < contact.count; ++k) {
      points.push_back(
          {{first, second}, from_gazebo(contact.positions[k]), from_gazebo(contact.normals[k])});
    }
  }
  return points;
}

protocol::Distances GazeboSimulation::cast(const protocol::CastRays& rays) {
  return rays_->cast(rays);
}

protocol::Picture GazeboSimulation::render(const protocol::Render& view) {
  protocol::Picture picture;
  if (!in_main_thread([&] { picture = pictures_->draw(view); })) fail("Gazebo has been stopped");
  return picture;
}

// The limit must end the wait even if the rendering thread hangs.
bool GazeboSimulation::warm_up_in_main_thread(const std::function<void()>& job) {
  return main_thread_.run(job, [this] { return give_up_() || Clock::now() >= deadline_; });
}

bool GazeboSimulation::in_main_thread(const std::function<void()>& job) {
  return main_thread_.run(job, give_up_);
}

}  // namespace tether::gazebo_plugin
