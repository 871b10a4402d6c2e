#include "record_generator.h"

#include "altered_record.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <tether/base/random.h>

namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;

constexpr Duration kCameraPeriod{33'333'333};
constexpr Duration kCameraPhase{1'234'567};
constexpr Duration kMostCameraDelay{50'000'000};  // drawn from 0 up to this
constexpr Duration kMostRangeDelay{60'000'000};
constexpr Duration kTruthPeriod{9'999'999};  // no multiple of any step

// One SUT's life, in its own time.
class Sut {
 public:
  Sut(const GeneratorOptions& options, int index, Duration latency)
      : options_(options),
        uav_("uav" + std::to_string(index)),
        latency_(latency),
        random_({options.seed, static_cast<std::uint64_t>(index), 0}) {}

  std::vector<Interaction> live() {
    std::vector<Interaction> row;
    for (int i = 1; i <= options_.interactions_per_sut; ++i) {
      row.push_back(next(static_cast<std::uint64_t>(i), i == options_.interactions_per_sut));
      et_ = to_ns(row.back().reply_at);
    }
    return row;
  }

 private:
  Interaction next(std::uint64_t sequence, bool last) {
    Interaction message;
    message.uav = uav_;
    message.sequence = sequence;
    et_ += 1 + below(random_.bits() % 4 == 0 ? 20'000'000 : 700'000);
    if (random_.bits() % 8 == 0) et_ = ceil_ns(et_, to_ns(options_.step));  // on a boundary
    message.request_at = message.reply_at = from_ns<ExecTime>(et_);
    if (last) {
      message.kind = record::kFinish;
      return message;
    }
    using Plan = void (Sut::*)(Interaction&);
    constexpr Plan kPlans[] = {&Sut::command, &Sut::command, &Sut::sleep, &Sut::camera,
                               &Sut::range};
    (this->*kPlans[random_.bits() % 5])(message);
    return message;
  }

  void command(Interaction& message) {
    message.kind = record::kCommand;
    const std::int64_t acts = et_ + to_ns(latency_);
    message.effect_at = from_ns<SimTime>(ceil_ns(acts, to_ns(options_.step)));
    message.command = {1, 0, 0, 0};
    message.grid_error = *message.effect_at - from_ns<SimTime>(acts);
  }

  void sleep(Interaction& message) {
    message.kind = record::kSleep;
    // Now and then until a time that is past already.
    message.sleep_until = from_ns<ExecTime>(et_ - 1'000'000 + below(30'000'000));
    message.reply_at = std::max(message.request_at, *message.sleep_until);
  }

  void range(Interaction& message) {
    message.kind = record::kSensor;
    message.sensor = "range";
    message.sample_index = range_index_++;
    set_sample(message, et_, et_ + below(to_ns(kMostRangeDelay)), to_ns(options_.step));
  }

  void camera(Interaction& message) {
    message.kind = record::kSensor;
    message.sensor = "camera";
    message.latest = random_.bits() % 4 == 0;
    std::uint64_t index = newest_available();
    if (index == kNone || (index < unread_ && !message.latest)) index = next_available();
    message.sample_index = index;
    unread_ = std::max(unread_, index + 1);
    set_sample(message, sampled_at(index), available_at(index), to_ns(options_.step));
  }

  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  std::int64_t sampled_at(std::uint64_t index) const {
    return to_ns(kCameraPhase) + static_cast<std::int64_t>(index) * to_ns(kCameraPeriod);
  }
  std::int64_t available_at(std::uint64_t index) const {
    KeyedRandom delay({options_.seed, random_stream(uav_, "camera", "delay"), index});
    return sampled_at(index) + static_cast<std::int64_t>(
                                   delay.uniform() * static_cast<double>(to_ns(kMostCameraDelay)));
  }
  // The newest camera measurement that is available now, wherever it is in the order of reading.
  std::uint64_t newest_available() const {
    for (auto k = static_cast<std::uint64_t>(et_ / to_ns(kCameraPeriod)) + 1; k-- > 0;)
      if (available_at(k) <= et_) return k;
    return kNone;
  }
  // The one of those not yet read that is available first. Delays are below two periods.
  std::uint64_t next_available() const {
    const auto candidates = {unread_, unread_ + 1, unread_ + 2};
    return *std::ranges::min_element(candidates, {},
                                     [this](std::uint64_t k) { return available_at(k); });
  }

  std::int64_t below(std::int64_t bound) {
    return static_cast<std::int64_t>(random_.uniform() * static_cast<double>(bound));
  }

  const GeneratorOptions& options_;
  std::string uav_;
  Duration latency_;
  KeyedRandom random_;
  std::int64_t et_ = 0;
  std::uint64_t unread_ = 0;
  std::uint64_t range_index_ = 0;
};

// An event on the host. Events of one ST are in the order of ET: ground truth and effects first
// (phases 0, 1), then arrivals before releases of the same timestamp (2, 3), last the arrivals of
// requests that are ahead of ST (4).
struct Event {
  std::int64_t st = 0;
  std::int64_t key = 0;
  int phase = 0;
  std::size_t sut = 0;
  Interaction* interaction = nullptr;

  auto rank() const { return std::tuple(st, key, phase, sut); }
};

class Host {
 public:
  explicit Host(const GeneratorOptions& options) : options_(options) {}

  Record run() {
    make_header();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (Interaction& interaction : rows_[i]) add_events(i, interaction);
    }
    end_ = options_.stop_at != SimTime::max() ? to_ns(options_.stop_at) : last_release_;
    add_ground_truth();
    std::ranges::stable_sort(events_, {}, &Event::rank);
    for (const Event& event : events_)
      if (event.st <= end_) happen(event);
    make_footer();
    return std::move(record_);
  }

 private:
  void make_header() {
    record_.header.policy = record::kConservativeBarrier;
    record_.header.step = options_.step;
    record_.header.seed = options_.seed;
    record_.header.ground_truth_period = kTruthPeriod;
    for (int i = 0; i < options_.suts; ++i) {
      const Duration latency(i * 1'700'000);
      const std::string uav = "uav" + std::to_string(i);
      record_.header.suts.push_back({uav, "test", {computer::ClockKind::kScripted}, latency});
      record_.header.sensors.push_back(
          {uav, "camera", "camera", true, kCameraPeriod, kCameraPhase, {}, kMostCameraDelay});
      record_.header.sensors.push_back({uav, "range", "range", false, {}, {}, {}, kMostRangeDelay});
      rows_.push_back(Sut(options_, i, latency).live());
    }
  }

  void add_events(std::size_t sut, Interaction& message) {
    const std::int64_t step = to_ns(options_.step);
    const std::int64_t request = to_ns(message.request_at);
    const std::int64_t reply = to_ns(message.reply_at);
    const std::int64_t release = floor_ns(reply, step);

    // On arrival ST is anywhere from the SUT's last release up to its request.
    std::int64_t& previous = last_release_of_[sut];
    const std::int64_t bound = floor_ns(request, step);
    KeyedRandom random({options_.seed, 1000 + sut, message.sequence});
    const auto steps_ahead = static_cast<double>((bound - previous) / step + 1);
    const std::int64_t arrival =
        previous + static_cast<std::int64_t>(random.uniform() * steps_ahead) * step;
    message.st_at_arrival = from_ns<SimTime>(arrival);
    message.st_at_release = from_ns<SimTime>(release);
    message.lag = Duration(request - arrival);
    message.grid_error = std::max(message.grid_error, Duration(reply - release));
    previous = release;
    last_release_ = std::max(last_release_, release);

    const bool in_time = arrival == bound;
    events_.push_back(
        {arrival, in_time ? request : arrival + step, in_time ? 2 : 4, sut, &message});
    events_.push_back({release, reply, 3, sut, &message});
    if (message.effect_at) events_.push_back({to_ns(*message.effect_at), 0, 1, sut, &message});
  }

  void add_ground_truth() {
    const auto instant = [&](std::int64_t k) {
      return ceil_ns(k * to_ns(kTruthPeriod), to_ns(options_.step));
    };
    for (std::int64_t k = 0; instant(k) <= end_; ++k)
      for (std::size_t sut = 0; sut < rows_.size(); ++sut)
        events_.push_back({instant(k), 0, 0, sut, nullptr});
  }

  void happen(const Event& event) {
    const SimTime st = from_ns<SimTime>(event.st);
    wall_ += Duration(1000);
    switch (event.phase) {
      case 0: {
        record::GroundTruth truth;
        truth.uav = record_.header.suts[event.sut].uav;
        truth.at = st;
        record_.ground_truth.push_back({st, order_++, truth});
        break;
      }
      case 1:
        record_.commands.push_back(
            {st, order_++, {event.interaction->uav, event.interaction->sequence, st, 1, 0, 0, 0}});
        break;
      case 3:
        event.interaction->wall_at_release = options_.wall_times ? wall_ : WallTime{};
        record_.interactions.push_back({st, order_++, *event.interaction});
        break;
      default:
        event.interaction->wall_at_arrival = options_.wall_times ? wall_ : WallTime{};
    }
  }

  void make_footer() {
    record::Footer footer;
    footer.end = options_.stop_at == SimTime::max() ? "finished" : "time_limit";
    footer.st_at_end = from_ns<SimTime>(end_);
    std::map<std::string, ExecTime> et;
    std::map<std::string, bool> finished;
    for (const auto& entry : record_.interactions) {
      et[entry.message.uav] = entry.message.reply_at;
      finished[entry.message.uav] = entry.message.kind == record::kFinish;
    }
    for (const record::SutInfo& sut : record_.header.suts) {
      const ExecTime reached = same_instant(footer.st_at_end);
      footer.et_at_end.push_back(finished[sut.uav] ? et[sut.uav] : std::max(et[sut.uav], reached));
    }
    record_.footer = footer;
    set_figures(record_);
  }

  const GeneratorOptions& options_;
  Record record_;
  std::vector<std::vector<Interaction>> rows_;
  std::vector<Event> events_;
  std::map<std::size_t, std::int64_t> last_release_of_;
  std::int64_t last_release_ = 0;
  std::int64_t end_ = 0;
  WallTime wall_ = from_ns<WallTime>(1'000'000'000);
  std::uint64_t order_ = 0;
};

}  // namespace

Record generate(const GeneratorOptions& options) {
  return Host(options).run();
}

}  // namespace tether::audit
