#pragma once

#include <tether/os/file_descriptor.h>

namespace tether::client {

using os::FileDescriptor;

}  // namespace tether::client
