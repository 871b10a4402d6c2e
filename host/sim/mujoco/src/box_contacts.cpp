// The engine finds the contact of a convex shape with a box by the line between their centres: the
// contact's normal is that of the face through which this line leaves both. A wide floor is thin,
// and the line to its centre is nearly flat: for a UAV far from the centre, the normal pointed
// sideways as soon as its hull was some millimetres deep, and the engine threw it out with 30 m/s.
// Here the engine is given that part of the box only which is near the other shape.

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

int collide(const mjModel* model, const mjData* data, mjContact* contacts, int geom1, int geom2,
            mjtNum margin) {
  const bool is_first = model->geom_type[geom1] == mjGEOM_BOX;
  const NearPart part(*model, *data, is_first ? geom1 : geom2, is_first ? geom2 : geom1);
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
