#include "vehicle/stage_log.h"

#include <algorithm>
#include <cmath>

#include <tether/base/text.h>
#include <tether/link/codec.h>

namespace tether::client {
namespace {

Failure invalid(const std::string& what) {
  return {Failure::Kind::kInvalid, what};
}

}  // namespace

link::StageTime& StageLog::time_of_current() {
  return time_of(open_.empty() ? "" : open_.back());
}

link::StageTime& StageLog::time_of(const std::string& stage) {
  for (link::StageTime& time : times_)
    if (time.stage == stage) return time;
  return times_.emplace_back(link::StageTime{stage, Duration(0)});
}

void StageLog::reach(ExecTime at) {
  time_of_current().computing += std::max(Duration(0), at - reached_);
  reached_ = at;
}

// What rounding leaves is that of the last one, so that the sum is exact.
void StageLog::reach(ExecTime at, const Computed& parts) {
  Computed grown;
  Duration all{0};
  for (const auto& [name, computed] : parts)
    if (const Duration more = computed - parts_[name]; more > Duration(0)) {
      grown[name] = more;
      all += more;
    }
  parts_ = parts;
  Duration left = std::max(Duration(0), at - reached_);
  if (!parts.empty() && left == Duration(0)) return;
  if (grown.empty() || !open_.empty() || times_.size() + grown.size() + 1 > link::kMaxStages)
    return reach(at);
  reached_ = at;
  for (const auto& [name, computed] : grown) {
    const double share = static_cast<double>(computed.count()) / static_cast<double>(all.count());
    const Duration own(std::llround(share * static_cast<double>(left.count())));
    time_of(name).computing += own;
    left -= own;
    all -= computed;
  }
}

Duration StageLog::take(std::vector<link::StageTime>& given, const std::string& outside) {
  time_of_current();
  Duration sum{0};
  for (link::StageTime& time : times_) {
    const std::string& name = time.stage.empty() ? outside : time.stage;
    const auto found = std::find_if(given.begin(), given.end(),
                                    [&](const link::StageTime& g) { return g.stage == name; });
    if (found == given.end()) continue;
    time.computing += found->computing;
    sum += found->computing;
    given.erase(found);
  }
  reached_ += sum;
  return sum;
}

Status StageLog::begin(std::string_view stage) {
  const std::string name(stage);
  if (name.empty() || name.size() > link::kMaxNameBytes || printable(name) != name)
    return invalid("the name of a stage must have 1 to " + std::to_string(link::kMaxNameBytes) +
                   " bytes, no control characters and no blanks at its ends");
  // One more for what is outside of stages.
  if (open_.size() + 1 >= link::kMaxStages || times_.size() + 1 >= link::kMaxStages)
    return invalid("more than " + std::to_string(link::kMaxStages - 2) +
                   " stages between two calls");
  open_.push_back(name);
  return ok_status();
}

Status StageLog::end() {
  if (open_.empty()) return invalid("no stage is open");
  open_.pop_back();
  return ok_status();
}

std::vector<link::StageTime> StageLog::times(const std::string& outside) const {
  std::vector<link::StageTime> named = times_;
  for (link::StageTime& time : named)
    if (time.stage.empty()) time.stage = outside;
  return named;
}

void StageLog::resume(ExecTime at) {
  times_.clear();
  reached_ = at;
}

}  // namespace tether::client
