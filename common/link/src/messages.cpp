#include <tether/link/messages.h>

namespace tether::link {

std::string_view name(ClockKind kind) {
  switch (kind) {
    case ClockKind::kWall:
      return "wall";
    case ClockKind::kCpu:
      return "cpu";
    case ClockKind::kScripted:
      return "scripted";
    case ClockKind::kUnstamped:
      return "unstamped";
  }
  return "unknown";
}

std::string_view name(Refusal::Reason reason) {
  switch (reason) {
    case Refusal::Reason::kVersion:
      return "version";
    case Refusal::Reason::kToken:
      return "token";
    case Refusal::Reason::kUav:
      return "uav";
    case Refusal::Reason::kBadMessage:
      return "bad message";
    case Refusal::Reason::kBadRequest:
      return "bad request";
    case Refusal::Reason::kRunEnded:
      return "run ended";
  }
  return "unknown";
}

}  // namespace tether::link
