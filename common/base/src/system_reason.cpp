#include <cerrno>
#include <cstring>
#include <system_error>

#include <tether/base/error.h>

namespace tether {

std::string reason_of(int error_number) {
  const std::string reason = std::generic_category().message(error_number);
  const bool has_too_many_files = error_number == EMFILE || error_number == ENFILE;
  return has_too_many_files ? reason + "; allow this process more (ulimit -n)" : reason;
}

std::string name_of_signal(int signal) {
  return "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

}  // namespace tether
