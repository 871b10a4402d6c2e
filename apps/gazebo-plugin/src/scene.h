#pragma once

#include <string>
#include <vector>

#include <gazebo/physics/PhysicsTypes.hh>
#include <gazebo/rendering/RenderTypes.hh>

#include <tether/sim_protocol/messages.h>

/// The scene that Gazebo draws, which it fills from messages, some time after the world. In the
/// main thread only, but for `expected_visuals`.
namespace tether::gazebo_plugin {

/// Names of all visuals of all models of the world. In the thread of the physics.
std::vector<std::string> expected_visuals(const ::gazebo::physics::WorldPtr& world);

/// The world's scene; none as long as there is none that is complete.
::gazebo::rendering::ScenePtr complete_scene(const std::string& world_name);

/// Which of them the scene has not yet.
std::vector<std::string> missing_visuals(const ::gazebo::rendering::ScenePtr& scene,
                                         const std::vector<std::string>& expected);

/// Gives visuals the textures that Gazebo's own reading of SDF leaves out.
/// @throws Error naming a visual that is not there, or a texture that cannot be read.
void apply_looks(const ::gazebo::rendering::ScenePtr& scene,
                 const std::vector<sim::protocol::Look>& looks);

}  // namespace tether::gazebo_plugin
