#pragma once

#include <gazebo/physics/Link.hh>
#include <gazebo/physics/Model.hh>
#include <gazebo/physics/World.hh>

namespace tether::gazebo_plugin {

template <class Visit>
void for_each_link(const ::gazebo::physics::ModelPtr& model, const Visit& visit) {
  for (const ::gazebo::physics::LinkPtr& link : model->GetLinks()) visit(link);
  for (const ::gazebo::physics::ModelPtr& nested : model->NestedModels()) {
    for_each_link(nested, visit);
  }
}

/// In the order of the world file.
template <class Visit>
void for_each_link(const ::gazebo::physics::WorldPtr& world, const Visit& visit) {
  for (const ::gazebo::physics::ModelPtr& model : world->Models()) for_each_link(model, visit);
}

}  // namespace tether::gazebo_plugin
