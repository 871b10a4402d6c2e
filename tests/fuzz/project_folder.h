#pragma once

#include "fuzz_target.h"

namespace tether::fuzz {

/// The project's files with an input among them, where paths in it lead to the shipped ones: in
/// `<folder>/scenarios/`, beside `<folder>/worlds/` and the others.
class ProjectFolder {
 public:
  ProjectFolder() {
    for (const char* name : {"models", "worlds", "profiles", "missions"}) {
      std::filesystem::create_directory_symlink(
          std::filesystem::path(TETHER_SOURCE_DIR) / "data" / name, folder_.path() / name);
    }
    folder_.write("scenarios/delays.txt", std::string_view("10\n20\n30.5\n"));
    folder_.write("scenarios/base.toml", std::string_view(kBase));
  }
  std::filesystem::path write(const std::string& name, Bytes input) const {
    return folder_.write("scenarios/" + name, input);
  }

 private:
  /// A scenario for campaigns to name.
  static constexpr const char* kBase = R"(name = "base"
world = "../worlds/room.sdf"
time_limit_s = 60
[[uav]]
name = "uav"
model = "../models/hummingbird/model.sdf"
position_m = [0, 0, 1]
[sut]
command = ["tether-sut"]
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "cpu"
)";
  InputFolder folder_;
};

}  // namespace tether::fuzz
