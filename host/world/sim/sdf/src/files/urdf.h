#pragma once

#include <filesystem>
#include <string>

#include <tinyxml2.h>

namespace tether::sim {

/// The SDF that libsdformat makes of a robot in URDF, as ROS has them, on one line: what is about
/// it has the first line of the file as its place. Links on fixed joints become a part of their
/// parents; what is in <gazebo> is taken as it is.
/// @throws Error(kBadFile) with file and line if it is a template of xacro, or no URDF.
std::string sdf_of_urdf(const std::filesystem::path& file, const tinyxml2::XMLElement& robot,
                        const std::string& text);

}  // namespace tether::sim
