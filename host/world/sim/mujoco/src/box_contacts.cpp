// The engine finds the contact of a convex shape with a box by the line between their centres: the
// contact's normal is that of the face through which this line leaves both. A wide floor is thin,
// and the line to its centre is nearly flat: for a UAV far from the centre, the normal pointed
// sideways as soon as its hull was some millimetres deep, and the engine threw it out with 30 m/s.
// Here the engine is given that part of the box only which is near the other shape.
//
// A patch of a mesh (convex_patches.h) is thinner than what hits it, and the engine pushed that out
// on either side. It is the plane of the side on which the other shape is, for those points of
// contact that are nearer to that plane than to the patch's edge.
//
// The engine also finds one point of contact only, so that what stands on a box rocks for ever, and
// an IMU on it measures several m/s². Over a face that is wider than the other shape, a box is a
// half space: there, the engine's functions for planes find all points.

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

// Of a mesh that is a thin plate: the axis across it; −1: it is none.
int axis_across(const mjModel& model, int mesh) {
  constexpr mjtNum kThin_m = 0.007;
  const mjtNum* const half = model.geom_size + 3 * mesh;
  for (int i = 0; i < 3; ++i)
    if (half[i] <= kThin_m && half[i] < half[(i + 1) % 3] && half[i] < half[(i + 2) % 3]) return i;
  return -1;
}

// How far a point is from the edge of a thin plate; negative outside of it.
mjtNum from_edge_m(const mjModel& model, const mjData& data, int geom, int axis,
                   const mjtNum* p_W) {
  const int mesh = model.geom_dataid[geom];
  const float* const vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  mjtNum from_center_W[3], p[3];
  mju_sub3(from_center_W, p_W, data.geom_xpos + 3 * geom);
  mju_rotVecMatT(p, from_center_W, data.geom_xmat + 9 * geom);
  mjtNum least = mjMAXVAL;
  const int first = model.mesh_faceadr[mesh];
  for (int face = first; face < first + model.mesh_facenum[mesh]; ++face) {
    mjtNum corner[3][3], ab[3], ac[3], normal[3], from_corner[3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) corner[i][k] = vertices[3 * model.mesh_face[3 * face + i] + k];
    mju_sub3(ab, corner[1], corner[0]);
    mju_sub3(ac, corner[2], corner[0]);
    mju_cross(normal, ab, ac);
    mju_normalize3(normal);
    if (mju_abs(normal[axis]) > 0.5) continue;  // not a side
    mju_sub3(from_corner, p, corner[0]);
    least = mju_min(least, -mju_dot3(normal, from_corner));
  }
  return least;
}

int collide_mesh(const mjModel* model, const mjData* data, mjContact* contacts, int geom1,
                 int geom2, mjtNum margin) {
  // The first geom's type is never the greater one.
  const int axis = axis_across(*model, geom2);
  const mjfCollision on_plane = mjCOLLISIONFUNC[mjGEOM_PLANE][model->geom_type[geom1]];
  if (axis >= 0 && on_plane != nullptr) {
    mjtNum apart_W[3], p[3];
    mju_sub3(apart_W, data->geom_xpos + 3 * geom1, data->geom_xpos + 3 * geom2);
    mju_rotVecMatT(p, apart_W, data->geom_xmat + 9 * geom2);
    const mjtNum side = p[axis] > 0 ? 1 : -1;
    int found = 0;
    {
      const AsPlane plane(*data, geom2, model->geom_size + 3 * geom2, axis, side);
      found = on_plane(model, data, contacts, geom2, geom1, margin);
    }
    const auto is_beside = [&](const mjContact& contact) {
      return from_edge_m(*model, *data, geom2, axis, contact.pos) < -contact.dist;
    };
    found = static_cast<int>(std::remove_if(contacts, contacts + found, is_beside) - contacts);
    for (int i = 0; i < found; ++i) mju_scl3(contacts[i].frame, contacts[i].frame, -1);
    if (found > 0) return found;
  }
  const bool has_box = model->geom_type[geom1] == mjGEOM_BOX;
  return (has_box ? collide : collide_convex)(model, data, contacts, geom1, geom2, margin);
}

bool install() {
  collide_convex = mjCOLLISIONFUNC[mjGEOM_CYLINDER][mjGEOM_BOX];
  for (int type = 0; type < mjNGEOMTYPES; ++type)
    for (mjfCollision* function :
         {&mjCOLLISIONFUNC[type][mjGEOM_BOX], &mjCOLLISIONFUNC[mjGEOM_BOX][type]})
      if (*function == collide_convex) *function = collide;
  for (mjfCollision(&of_type)[mjNGEOMTYPES] : mjCOLLISIONFUNC)
    if (of_type[mjGEOM_MESH] == collide_convex || of_type[mjGEOM_MESH] == collide)
      of_type[mjGEOM_MESH] = collide_mesh;
  return true;
}

}  // namespace

void install_box_contacts() {
  static const bool is_installed = install();
  static_cast<void>(is_installed);
}

}  // namespace tether::sim
