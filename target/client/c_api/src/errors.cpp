#include "errors.h"

#include <algorithm>
#include <array>

namespace tether::c_api {
namespace {

// No std::string: keeping an error must not fail, and a thread that ends has nothing to destroy.
constexpr std::size_t kLongest = 511;
thread_local std::array<char, kLongest + 1> last_error{};

struct Name {
  tether_status status;
  const char* text;
};
constexpr std::array kNames{Name{TETHER_OK, "ok"},
                            Name{TETHER_INVALID, "invalid"},
                            Name{TETHER_NOTHING_YET, "nothing yet"},
                            Name{TETHER_REFUSED, "refused"},
                            Name{TETHER_DISCONNECTED, "disconnected"},
                            Name{TETHER_PROTOCOL, "protocol"},
                            Name{TETHER_TIMEOUT, "timeout"},
                            Name{TETHER_RUN_ENDED, "run ended"},
                            Name{TETHER_NO_MEMORY, "no memory"},
                            Name{TETHER_INTERNAL, "internal"}};

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

}  // namespace

tether_status to_c(Failure::Kind kind) noexcept {
  switch (kind) {
    case Failure::Kind::kRefused:
      return TETHER_REFUSED;
    case Failure::Kind::kDisconnected:
      return TETHER_DISCONNECTED;
    case Failure::Kind::kProtocol:
      return TETHER_PROTOCOL;
    case Failure::Kind::kTimeout:
      return TETHER_TIMEOUT;
    case Failure::Kind::kRunEnded:
      return TETHER_RUN_ENDED;
    case Failure::Kind::kInvalid:
      return TETHER_INVALID;
    case Failure::Kind::kNothingYet:
      return TETHER_NOTHING_YET;
  }
  return TETHER_INTERNAL;
}

tether_status fail(tether_status status, std::string_view message) noexcept {
  std::size_t length = std::min(message.size(), kLongest);
  // Between characters, also where it is cut.
  while (length > 0 && length < message.size() && continues_character(message[length])) --length;
  std::copy_n(message.begin(), length, last_error.begin());
  last_error[length] = '\0';
  return status;
}

tether_status fail(const Failure& failure) noexcept {
  return fail(to_c(failure.kind), failure.message);
}

}  // namespace tether::c_api

extern "C" {

const char* tether_last_error(void) noexcept {
  return tether::c_api::last_error.data();
}

const char* tether_status_name(tether_status status) noexcept {
  for (const auto& name : tether::c_api::kNames)
    if (name.status == status) return name.text;
  return "unknown";
}

}  // extern "C"
