#pragma once

#include <string>

namespace tether::scenario {

/// A target of this host that uses every key it can have.
inline const std::string kFullTarget = R"(name = "slow"
description = "every key"
clock = "cpu"
cpu_factor = 6.5
cores = 2
launcher = ["qemu-aarch64", "-L", "../sysroot"]
program_folder = "../arm64/bin"
)";

/// A board.
inline const std::string kBoardTarget = R"(name = "pi"
address = "ssh://user@board:2222"
launcher = ["nice", "-n", "-5", "./wrap"]
program_folder = "bin"
)";

}  // namespace tether::scenario
