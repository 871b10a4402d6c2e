#pragma once

namespace tether::sim {

/// Makes the engine find the contacts of cylinders, ellipsoids and meshes with large boxes right,
/// and those of any shape with a thin plate, such as a patch of a mesh. For the whole process; a
/// second call does nothing.
void install_box_contacts();

}  // namespace tether::sim
