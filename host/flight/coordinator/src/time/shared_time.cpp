#include "time/shared_time.h"

#include <algorithm>
#include <deque>

namespace tether::coordinator {

class SharedTime final : public OwnTime {
 public:
  SharedTime(const SutStart& sut, sync::SharedCores& cores, std::size_t program)
      : OwnTime(sut, facts_of(sut.hello.clock)), cores_(&cores), program_(program) {}

  using Timeline::uav;
  std::optional<ExecTime> last_stamp() const override { return last_stamp_; }
  bool is_computing() const override { return !unsettled() && OwnTime::is_computing(); }
  const link::Request* unsettled() const override {
    return messages_.empty() ? nullptr : std::get_if<link::Request>(&messages_.back().message);
  }
  bool awaits_message() const { return awaits_message_; }

  std::optional<Stop> progress(const link::Progress& progress) override {
    if (is_computing()) cores_->progress(program_, work_until(progress.reached));
    return std::nullopt;
  }
  // While it is held, it sends nothing but annotations, which take no time.
  std::optional<Sent> send(Sent sent) override {
    if (!is_computing()) return OwnTime::send(std::move(sent));
    sent.work = work_until(sent.stamp());
    messages_.push_back(std::move(sent));
    ask();
    return std::nullopt;
  }
  // Its first message was sent at `at`.
  Sent settle(ExecTime at) {
    Sent sent = std::move(messages_.front());
    messages_.pop_front();
    sent.at = at;
    has_asked_ = false;
    if (std::holds_alternative<link::Annotation>(sent.message)) {
      cores_->go_on(program_);
      ask();
    }
    return sent;
  }
  // Whether the bound has grown.
  bool raise_bound() {
    const ExecTime before = bound();
    barrier().progress(uav(), cores_->bound(program_));
    return bound() != before;
  }
  // By its own count: its stamp may be before what it had reached.
  sync::Arrival arrive(const Sent& sent) override {
    sync::Arrival arrival = OwnTime::arrive(sent);
    arrival.violation.reset();
    const Duration behind = resumed_at() + *sent.work - sent.stamp();
    if (behind > Duration(0))
      arrival.violation = {sync::CausalityViolation::Kind::kRequestInThePast, behind};
    return arrival;
  }
  // While it is held, it takes no share of the cores.
  std::optional<link::Due> hold(const record::Interaction& call) override {
    awaits_message_ = call.receive_until && call.reply_at > call.request_at;
    if (call.kind == record::kFinish)
      cores_->leave(program_);
    else
      cores_->resume(program_, call.reply_at);
    return OwnTime::hold(call);
  }
  std::optional<link::Due> move_up(sync::CallId call, ExecTime reply_at) override {
    awaits_message_ = false;
    if (reply_at < bound()) cores_->resume(program_, reply_at);
    return OwnTime::move_up(call, reply_at);
  }
  void replied(const record::Interaction& call) override {
    OwnTime::replied(call);
    last_stamp_ = call.reply_at;
    awaits_message_ = false;
  }
  void leave() override {
    OwnTime::leave();
    cores_->leave(program_);
    messages_.clear();
    awaits_message_ = false;
  }

 private:
  static Facts facts_of(const computer::Clock& clock) {
    Facts facts = OwnTime::facts_of(clock);
    facts.shares_board = true;
    return facts;
  }
  // What it computed until `stamp`, as if alone. Not less than before.
  Duration work_until(ExecTime stamp) {
    last_stamp_ = std::max(last_stamp_, stamp);
    return last_stamp_ - resumed_at();
  }
  // Annotations wait for the request after them, unless progress tells of the SUT's work meanwhile:
  // that arrives at any time, and others' ST must not depend on when annotations arrive.
  void ask() {
    const bool hears_of_work = !facts().repeats;
    if (has_asked_ || messages_.empty() || !(unsettled() || hears_of_work)) return;
    cores_->ask(program_, *messages_.front().work);
    has_asked_ = true;
  }

  sync::SharedCores* cores_;
  std::size_t program_;
  ExecTime last_stamp_{};
  std::deque<Sent> messages_;    // whose instant is not known
  bool has_asked_ = false;       // for the first one
  bool awaits_message_ = false;  // an open `receive` that a message can end earlier
};

std::unique_ptr<Timeline> Pool::add(const SutStart& sut) {
  auto time = std::make_unique<SharedTime>(sut, cores_, suts_.size());
  suts_.push_back(time.get());
  return time;
}

bool Pool::has(std::size_t uav) const {
  return std::ranges::find(suts_, uav, &SharedTime::uav) != suts_.end();
}

std::optional<Sent> Pool::next(ExecTime until, const Used& used) {
  const auto stamp = cores_.next(until, [&](const sync::SharedCores::Use& use) {
    used(suts_[use.program]->uav(), use.from, use.to, use.cores);
  });
  return stamp ? std::optional(suts_[stamp->program]->settle(stamp->at)) : std::nullopt;
}

bool Pool::raise_bounds() {
  return std::ranges::count_if(suts_, &SharedTime::raise_bound) > 0;
}

bool Pool::awaits_message() const {
  return std::ranges::any_of(suts_, &SharedTime::awaits_message);
}

}  // namespace tether::coordinator
