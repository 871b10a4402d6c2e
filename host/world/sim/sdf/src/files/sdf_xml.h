#pragma once

#include <filesystem>
#include <memory>

#include <tinyxml2.h>

namespace tether::sim {

/// Reads a file as XML whose outermost element is <sdf>, or URDF as such (sdf_of_urdf).
/// @throws Error(kBadFile) with file and line: no such file, a directory, not well-formed XML, not
/// UTF-8 outside of comments, another outermost element.
std::unique_ptr<tinyxml2::XMLDocument> read_xml(const std::filesystem::path& file);

}  // namespace tether::sim
