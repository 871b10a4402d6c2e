#include <tether/base/version.h>

namespace tether {

std::string_view version() {
  return TETHER_VERSION;
}

}  // namespace tether
