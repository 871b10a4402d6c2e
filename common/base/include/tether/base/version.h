#pragma once

#include <string_view>

namespace tether {

/// The project's version and, where it was built from a repository, the commit: "0.1.0+1a2b3c4".
std::string_view version();

}  // namespace tether
