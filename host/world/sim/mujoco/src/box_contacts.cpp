// The engine finds the contact of a convex shape with a box by the line between their centres: the
// contact's normal is that of the face through which this line leaves both. A wide floor is thin,
// and the line to its centre is nearly flat: for a UAV far from the centre, the normal pointed
// sideways as soon as its hull was some millimetres deep, and the engine threw it out with 30 m/s.
// Here the engine is given that part of the box only which is near the other shape.
//
// It also finds one point of contact only, so that what stands on a box rocks for ever, and an IMU
// on it measures several m/s². Over a face that is wider than the other shape, a box is a half
// space: there, the engine's functions for planes find all points.

#include "box_contacts.h"

#include <algorithm>

#include <mujoco/mujoco.h>

namespace tether::sim {
namespace {

// Of the radius of the other shape: no contact is as deep, so that where the box is cut off does
// not matter.
constexpr mjtNum kReach = 3.0;

// The engine's own function for convex shapes.
mjfCollision collide_convex = nullptr;

// The box of a geom while the engine looks at it, cut to what is near another geom.
class NearPart {
 public:
  NearPart(const mjModel& model, const mjData& data, int box, int other)
      // Both belong to the caller of mj_step(), who may write them.
      : half_(const_cast<mjtNum*>(model.geom_size) + 3 * box),
        center_(const_cast<mjtNum*>(data.geom_xpos) + 3 * box) {
    std::copy_n(half_, 3, whole_half_);
    std::copy_n(center_, 3, whole_center_);
    const mjtNum* const R = data.geom_xmat + 9 * box;
    const mjtNum reach = kReach * model.geom_rbound[other];
    mjtNum apart_W[3], p[3], shift[3], shift_W[3];
    mju_sub3(apart_W, data.geom_xpos + 3 * other, center_);
    mju_rotVecMatT(p, apart_W, R);
    for (int i = 0; i < 3; ++i) {
      const mjtNum low = std::max(-half_[i], p[i] - reach), high = std::min(half_[i], p[i] + reach);
      if (high <= low) return;  // far from each other
      shift[i] = (low + high) / 2;
    }
    for (int i = 0; i < 3; ++i) half_[i] = std::min(half_[i], p[i] + reach) - shift[i];
    mju_rotVecMat(shift_W, shift, R);
    mju_addTo3(center_, shift_W);
  }
  ~NearPart() {
    std::copy_n(whole_half_, 3, half_);
    std::copy_n(whole_center_, 3, center_);
  }
  NearPart(const NearPart&) = delete;
  NearPart& operator=(const NearPart&) = delete;

 private:
  mjtNum* half_;
  mjtNum* center_;
  mjtNum whole_half_[3], whole_center_[3];
};

// A box that looks to the engine like the plane of one of its faces.
class AsPlane {
 public:
  AsPlane(const mjData& data, int box, const mjtNum* half, int axis, mjtNum side)
      : center_(const_cast<mjtNum*>(data.geom_xpos) + 3 * box),
        axes_(const_cast<mjtNum*>(data.geom_xmat) + 9 * box) {
    std::copy_n(center_, 3, whole_center_);
    std::copy_n(axes_, 9, whole_axes_);
    // The columns are the axes of a plane's frame, of which z is the normal.
    for (int row = 0; row < 3; ++row) {
      const mjtNum* const of_row = whole_axes_ + 3 * row;
      axes_[3 * row] = side * of_row[(axis + 1) % 3];
      axes_[3 * row + 1] = of_row[(axis + 2) % 3];
      axes_[3 * row + 2] = side * of_row[axis];
      center_[row] += half[axis] * axes_[3 * row + 2];
    }
  }
  ~AsPlane() {
    std::copy_n(whole_center_, 3, center_);
    std::copy_n(whole_axes_, 9, axes_);
  }
  AsPlane(const AsPlane&) = delete;
  AsPlane& operator=(const AsPlane&) = delete;

 private:
  mjtNum* center_;
  mjtNum* axes_;
  mjtNum whole_center_[3], whole_axes_[9];
};

// The axis along which another geom is beside the box, all of it over that face; −1: there is none.
int axis_of_face(const mjModel& model, const mjData& data, int box, int other, mjtNum& side) {
  const mjtNum* const half = model.geom_size + 3 * box;
  mjtNum apart_W[3], p[3];
  mju_sub3(apart_W, data.geom_xpos + 3 * other, data.geom_xpos + 3 * box);
  mju_rotVecMatT(p, apart_W, data.geom_xmat + 9 * box);
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    if (mju_abs(p[i]) + model.geom_rbound[other] <= half[i]) continue;
    if (axis >= 0 || mju_abs(p[i]) <= half[i]) return -1;
    axis = i;
    side = p[i] > 0 ? 1 : -1;
  }
  return axis;
}

int collide(const mjModel* model, const mjData* data, mjContact* contacts, int geom1, int geom2,
            mjtNum margin) {
  const bool is_first = model->geom_type[geom1] == mjGEOM_BOX;
  const int box = is_first ? geom1 : geom2, other = is_first ? geom2 : geom1;
  mjtNum side = 0;
  const int axis = axis_of_face(*model, *data, box, other, side);
  const mjfCollision on_plane = mjCOLLISIONFUNC[mjGEOM_PLANE][model->geom_type[other]];
  if (axis >= 0 && on_plane != nullptr) {
    const AsPlane plane(*data, box, model->geom_size + 3 * box, axis, side);
    const int found = on_plane(model, data, contacts, box, other, margin);
    // The normal of a contact points from the first geom to the second.
    for (int i = 0; i < found && !is_first; ++i) mju_scl3(contacts[i].frame, contacts[i].frame, -1);
    return found;
  }
  const NearPart part(*model, *data, box, other);
  return collide_convex(model, data, contacts, geom1, geom2, margin);
}

bool install() {
  collide_convex = mjCOLLISIONFUNC[mjGEOM_CYLINDER][mjGEOM_BOX];
  for (int type = 0; type < mjNGEOMTYPES; ++type)
    for (mjfCollision* function :
         {&mjCOLLISIONFUNC[type][mjGEOM_BOX], &mjCOLLISIONFUNC[mjGEOM_BOX][type]})
      if (*function == collide_convex) *function = collide;
  return true;
}

}  // namespace

void install_box_contacts() {
  static const bool is_installed = install();
  static_cast<void>(is_installed);
}

}  // namespace tether::sim
