#pragma once

#include <filesystem>

#include <tinyxml2.h>

#include <tether/base/error.h>

namespace tether::sim {

/// Changes what libsdformat gives up on, although it means something or nothing is lost without it:
/// empty frames of poses, clouds (which are not drawn), scripts of materials without a <uri>
/// or a name, models without a link, the reserved name "world" of a world, surfaces of other
/// planets. Warns of what differs then.
/// @param root <sdf>
void repair(const std::filesystem::path& file, tinyxml2::XMLElement& root, const WarningSink& warn);

}  // namespace tether::sim
