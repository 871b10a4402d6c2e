#pragma once

#include <string>

namespace tether::client {

/// The build id that the linker gave to this program, in hexadecimal digits; empty: it has none.
/// Does not name shared libraries, or the script that an interpreter runs.
std::string build_id();

}  // namespace tether::client
