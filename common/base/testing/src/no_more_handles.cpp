#include <unistd.h>

#include <tether/base_testing/no_more_handles.h>
#include <tether/base_testing/sanitizer.h>

namespace tether {

NoMoreHandles::NoMoreHandles() {
  getrlimit(RLIMIT_NOFILE, &before_);
  const int next = dup(STDIN_FILENO);
  close(next);
  const rlimit none{static_cast<rlim_t>(next), before_.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
}

NoMoreHandles::~NoMoreHandles() {
  setrlimit(RLIMIT_NOFILE, &before_);
}

bool NoMoreHandles::allows_exceptions() {
#if TETHER_ADDRESS_SANITIZER
  return false;
#else
  return true;
#endif
}

}  // namespace tether
