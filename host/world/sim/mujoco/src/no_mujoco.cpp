#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::sim {

const bool kHasMujoco = false;

MakeMujocoSimulator prepare_mujoco_simulator(World /*world*/, const WarningSink& /*warn*/,
                                             const std::optional<FileCache>& /*cache*/) {
  throw Error(ErrorCode::kSetup,
              "this build has no embedded simulator: install libmujoco-dev and libassimp-dev, "
              "and build again");
}

}  // namespace tether::sim
