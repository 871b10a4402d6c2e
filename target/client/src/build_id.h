#pragma once

#include <string>
#include <vector>

#include <tether/link/messages.h>

namespace tether::client {

/// The build id that the linker gave to this program, in hexadecimal digits; empty: it has none.
/// Does not name shared libraries, or the script that an interpreter runs.
std::string build_id();

/// A library that is loaded: its file, and its build id; empty: it has none.
struct LoadedLibrary {
  std::string file;
  std::string build_id;
};
std::vector<LoadedLibrary> loaded_libraries();

/// The arguments of this program, without its name.
std::vector<std::string> own_arguments();

/// What decides besides the program's own code how much it computes: its arguments, the content of
/// the files that they name, of a script also that of the modules in its folder and below, and the
/// libraries. Within the limits of link::validate: what is beyond them is one part with a digest.
/// A file's folder makes no difference.
std::vector<link::BuildPart> build_parts(const std::vector<std::string>& arguments,
                                         const std::vector<LoadedLibrary>& libraries);

}  // namespace tether::client
