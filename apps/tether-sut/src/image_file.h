#pragma once

#include <string>

#include <tether/base/result.h>
#include <tether/uav/samples.h>

namespace tether::sut {

/// Writes the image as PNG, whole or not at all. Fails (kInvalid) with one line that names the
/// file.
Status write_png(const std::string& path, const uav::CameraSample& image);

}  // namespace tether::sut
