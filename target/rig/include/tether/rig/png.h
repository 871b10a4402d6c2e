#pragma once

#include <string>

#include <tether/base/result.h>
#include <tether/uav/samples.h>

namespace tether::rig {

/// The image as the bytes of a PNG file. Fails with kInvalid if libpng cannot encode it.
Result<std::string> png_of(const uav::CameraSample& image);

}  // namespace tether::rig
