#include <tether/base/text.h>
#include <tether/link/messages.h>

namespace tether::link {

std::string stage_between(std::string_view previous_call, std::string_view call) {
  return std::string(previous_call).append(" to ").append(call);
}

std::string_view name(Refusal::Reason reason) {
  return enum_name(reason, {"version", "token", "uav", "bad message", "bad request", "run ended"});
}

}  // namespace tether::link
