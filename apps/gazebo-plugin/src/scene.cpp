#include "scene.h"

#include "links.h"

#include <algorithm>
#include <iterator>

#include <gazebo/rendering/rendering.hh>

namespace tether::gazebo_plugin {

// The first visual of a link represents the link itself, shows nothing, and has the link's name.
std::vector<std::string> expected_visuals(const ::gazebo::physics::WorldPtr& world) {
  std::vector<std::string> names;
  for_each_link(world, [&](const ::gazebo::physics::LinkPtr& link) {
    names.push_back(link->GetScopedName());
    const sdf::ElementPtr sdf = link->GetSDF();
    if (!sdf->HasElement("visual")) return;
    for (auto visual = sdf->GetElement("visual"); visual;
         visual = visual->GetNextElement("visual")) {
      names.push_back(link->GetScopedName() + "::" + visual->Get<std::string>("name"));
    }
  });
  return names;
}

::gazebo::rendering::ScenePtr complete_scene(const std::string& world_name) {
  const ::gazebo::rendering::ScenePtr scene = ::gazebo::rendering::get_scene(world_name);
  return scene && scene->Initialized() ? scene : nullptr;
}

std::vector<std::string> missing_visuals(const ::gazebo::rendering::ScenePtr& scene,
                                         const std::vector<std::string>& expected) {
  std::vector<std::string> missing;
  std::copy_if(expected.begin(), expected.end(), std::back_inserter(missing),
               [&](const std::string& name) { return !scene->GetVisual(name); });
  return missing;
}

}  // namespace tether::gazebo_plugin
