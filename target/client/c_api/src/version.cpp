#include <tether/base/version.h>
#include <tether/client.h>

extern "C" {

int32_t tether_client_abi_version(void) noexcept {
  return TETHER_CLIENT_ABI_VERSION;
}

const char* tether_client_version(void) noexcept {
  // A view of a literal, which ends with a zero byte.
  return tether::version().data();
}

}  // extern "C"
