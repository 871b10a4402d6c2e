#include <unistd.h>

#include <tether/os/file_descriptor.h>

namespace tether::os {

FileDescriptor::~FileDescriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace tether::os
