#include <algorithm>
#include <cassert>
#include <numeric>

#include <tether/sync/shared_cores.h>

namespace tether::sync {

SharedCores::SharedCores(int cores, std::size_t programs)
    : cores_(static_cast<CoreUnits>(cores)), programs_(programs) {
  assert(cores >= 1 && programs >= 1 && programs <= kMostPrograms);
  std::uint64_t multiple = 1;
  for (std::uint64_t n = 2; n <= programs; ++n) multiple = std::lcm(multiple, n);
  per_ns_ = multiple;
}

void SharedCores::progress(std::size_t program, Duration work) {
  Program& p = programs_[program];
  if (!p.asked) p.known = std::max(p.known, units(work));
}

void SharedCores::ask(std::size_t program, Duration work) {
  Program& p = programs_[program];
  assert(!p.asked && p.phase != Phase::kLeft && units(work) >= p.known);
  p.known = units(work);
  p.asked = true;
}

void SharedCores::resume(std::size_t program, ExecTime at) {
  assert(at >= now_);
  programs_[program] = {.phase = Phase::kWaiting, .resumes_at = at};
}

Duration SharedCores::rounded_up(CoreUnits work, CoreUnits rate) {
  return Duration(static_cast<std::int64_t>((work + rate - 1) / rate));
}

// Between two events the number of computing programs, and so the share of each, does not change.
std::optional<SharedCores::Stamp> SharedCores::next(ExecTime until, const Used& used) {
  while (true) {
    CoreUnits computing = 0;
    bool is_unknown = false;
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      Program& p = programs_[i];
      assert(p.phase != Phase::kStamped);
      if (p.phase == Phase::kWaiting && p.resumes_at <= now_) p.phase = Phase::kComputing;
      if (p.phase != Phase::kComputing) continue;
      ++computing;
      if (p.computed < p.known) continue;
      is_unknown = is_unknown || !p.asked;
      if (!p.asked) continue;
      p.asked = false;
      p.phase = Phase::kStamped;
      return Stamp{i, now_};
    }
    if (is_unknown || now_ >= until) return std::nullopt;

    const CoreUnits share = computing > cores_ ? per_ns_ * cores_ / computing : per_ns_;
    assert(share > 0);
    Duration step = Duration::max();
    for (const Program& p : programs_) {
      if (p.phase == Phase::kComputing)
        step = std::min(step, rounded_up(p.known - p.computed, share));
      if (p.phase == Phase::kWaiting) step = std::min(step, p.resumes_at - now_);
    }
    if (step == Duration::max()) return std::nullopt;
    step = std::min(step, until - now_);
    const double cores = static_cast<double>(share) / static_cast<double>(per_ns_);
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      if (programs_[i].phase != Phase::kComputing) continue;
      programs_[i].computed += CoreUnits(step.count()) * share;
      if (used) used({i, now_, now_ + step, cores});
    }
    now_ += step;
  }
}

ExecTime SharedCores::bound(std::size_t program) const {
  const Program& p = programs_[program];
  if (p.phase == Phase::kWaiting) return p.resumes_at;
  return now_ + (p.computed < p.known ? rounded_up(p.known - p.computed, per_ns_) : Duration(0));
}

}  // namespace tether::sync
