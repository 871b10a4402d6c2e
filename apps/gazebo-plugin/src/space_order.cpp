#include "space_order.h"

namespace tether::gazebo_plugin {

void SpaceOrder::remember(dSpaceID space) {
  std::vector<dGeomID> members;
  for (int i = 0; i < dSpaceGetNumGeoms(space); ++i) members.push_back(dSpaceGetGeom(space, i));
  spaces_.emplace_back(space, members);
  for (const dGeomID member : members) {
    if (dGeomIsSpace(member)) remember(reinterpret_cast<dSpaceID>(member));
  }
}

// ODE adds at the front.
void SpaceOrder::restore() const {
  for (const auto& [space, members] : spaces_) {
    for (const dGeomID member : members) dSpaceRemove(space, member);
    for (auto member = members.rbegin(); member != members.rend(); ++member) {
      dSpaceAdd(space, *member);
    }
  }
}

}  // namespace tether::gazebo_plugin
