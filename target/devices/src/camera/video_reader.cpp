#include "camera/video_reader.h"

#include <dlfcn.h>

namespace tether::devices {

Result<const VideoReader*> video_reader() {
  // Found by the search path of the program, and never closed: FFmpeg cannot be.
  static void* const kModule = ::dlopen("tether-video.so", RTLD_NOW | RTLD_LOCAL);
  static const void* const kReader =
      kModule == nullptr ? nullptr : ::dlsym(kModule, "tether_video_reader");
  if (kReader != nullptr) return static_cast<const VideoReader*>(kReader);
  return Failure{Failure::Kind::kInvalid,
                 "tether-video.so, which reads cameras, cannot be loaded. Install the package "
                 "tether-sut, or copy tether-video.so to the folder of tether-sut"};
}

}  // namespace tether::devices
