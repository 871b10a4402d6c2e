#include <unistd.h>

#include <tether/client/exec/file_descriptor.h>

namespace tether::client {

FileDescriptor::~FileDescriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace tether::client
