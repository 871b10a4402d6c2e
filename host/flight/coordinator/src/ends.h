#pragma once

#include <optional>
#include <utility>

#include <tether/base/text.h>
#include <tether/coordinator/coordinator.h>

namespace tether::coordinator {

/// How a run ends: now, at an instant of ST, or once all other SUTs have finished.
class Ends {
 public:
  bool is_over() const { return now_.has_value(); }
  /// @pre is_over()
  const Ending& how() const { return *now_; }

  /// The first one counts.
  void now(Ending ending) {
    if (now_) return;
    ending.reason = printable(ending.reason);
    ending.seen = printable(ending.seen);
    now_ = std::move(ending);
  }

  /// The earliest counts.
  void plan(SimTime at, Ending ending) {
    if (planned_ && at >= planned_->first) return;
    planned_ = {at, std::move(ending)};
  }
  bool is_planned() const { return planned_.has_value(); }
  /// How far ST may advance.
  SimTime limit() const { return planned_ ? planned_->first : SimTime::max(); }
  void reached(SimTime st) {
    if (planned_ && st >= planned_->first) now(planned_->second);
  }

  /// Once the others have finished. The first one counts.
  void later(Ending ending) {
    if (!later_) later_ = std::move(ending);
  }
  void all_have_finished() {
    now(later_.value_or(Ending{RunEnd::kFinished, "every SUT has finished"}));
  }

 private:
  std::optional<Ending> now_, later_;
  std::optional<std::pair<SimTime, Ending>> planned_;
};

}  // namespace tether::coordinator
