#pragma once

#include <string>
#include <vector>

#include <gazebo/physics/PhysicsTypes.hh>
#include <gazebo/rendering/RenderTypes.hh>

#include <tether/sim_protocol/messages.h>

/// The scene that Gazebo draws. Gazebo fills it from messages, later than the world. All functions
/// except `expected_visuals` must be called in the main thread.
namespace tether::gazebo_plugin {

/// Names of all visuals of all models of the world. To be called in the thread of the physics.
std::vector<std::string> expected_visuals(const ::gazebo::physics::WorldPtr& world);

/// The world's scene; none while it is incomplete.
::gazebo::rendering::ScenePtr complete_scene(const std::string& world_name);

/// The expected visuals that the scene does not have yet.
std::vector<std::string> missing_visuals(const ::gazebo::rendering::ScenePtr& scene,
                                         const std::vector<std::string>& expected);

/// Gives visuals the textures that Gazebo's own reading of SDF leaves out.
/// @throws Error with the name of a missing visual or of a texture that cannot be read.
void apply_materials(const ::gazebo::rendering::ScenePtr& scene,
                     const std::vector<sim::protocol::VisualMaterial>& materials);

}  // namespace tether::gazebo_plugin
