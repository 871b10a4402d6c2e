#pragma once

#include "time/timeline.h"

#include <algorithm>
#include <compare>
#include <set>

#include <tether/base/time.h>

namespace tether::coordinator {

/// An open call of a SUT in free running. From ST `due` on, its reply can be sent.
struct FreeCall {
  SimTime due;
  std::size_t uav = 0;
  sync::CallId id = 0;
  friend auto operator<=>(const FreeCall&, const FreeCall&) = default;
};

/// In free running, a SUT has no time but ST, and only what waits takes any (DESIGN section 2, rule
/// 8).
class FreeTime final : public Timeline {
 public:
  /// `calls`: those of all SUTs; must outlive this.
  FreeTime(std::set<FreeCall>& calls, StepGrid grid, std::size_t uav, bool is_concurrent)
      : Timeline(uav, {.is_serial = !is_concurrent}), calls_(&calls), grid_(grid) {}

  bool is_computing() const override {
    return !has_left() && std::ranges::find(*calls_, uav(), &FreeCall::uav) == calls_->end();
  }
  sync::Arrival arrive(const Sent& sent) override { return {.charged_at = same_instant(sent.st)}; }
  // A read is answered as soon as its sample's state is there. What waits ends at its time.
  std::optional<link::Due> hold(const record::Interaction& call) override {
    const SimTime due =
        call.sampled_at ? grid_.floor(*call.sampled_at) : grid_.ceil(same_instant(call.reply_at));
    calls_->insert({due, uav(), call.sequence});
    return std::nullopt;
  }
  std::optional<link::Due> move_up(sync::CallId call, ExecTime reply_at) override {
    std::erase_if(*calls_, [&](const auto& own) { return own.uav == uav() && own.id == call; });
    calls_->insert({grid_.ceil(same_instant(reply_at)), uav(), call});
    return std::nullopt;
  }
  void leave() override {
    Timeline::leave();
    std::erase_if(*calls_, [&](const FreeCall& call) { return call.uav == uav(); });
  }

 private:
  std::set<FreeCall>* calls_;
  StepGrid grid_;
};

}  // namespace tether::coordinator
