#include "agent.h"

#include "clocks.h"
#include "nmea.h"
#include "real.h"
#include "signals.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <tether/link/messages.h>
#include <tether/os/machine.h>

namespace tether::as_is {
namespace {

// How long a thread waits in real time before it looks at the time again. Who begins to wait last
// looks by itself whether all wait; the leader's thread looks again, for waits that are not seen.
constexpr Duration kShortestSlice = std::chrono::microseconds(500);
constexpr Duration kLongestSlice = std::chrono::milliseconds(5);
constexpr Duration kLongestUnwoken = std::chrono::milliseconds(1);
// One that tether-exec wakes looks again after so long, in case it does not hear that.
constexpr Duration kLongestToldSlice = std::chrono::milliseconds(200);
// A thread that waits beside one that computes looks so often for what has arrived [ET].
constexpr Duration kBetweenLooks = std::chrono::milliseconds(2);
// Messages that it takes at once: a serial port has little room.
constexpr std::uint32_t kTogether = 16;
// Of a wait without a deadline; then it begins again.
constexpr Duration kForEver = std::chrono::hours(1);

/// The eventfd that wakes the calling thread, with nothing in it.
int wake_of_thread() {
  struct Descriptor {
    int fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    Descriptor() = default;
    ~Descriptor() { TETHER_REAL(close)(fd); }
  };
  thread_local const Descriptor kDescriptor;
  std::uint64_t count = 0;
  static_cast<void>(TETHER_REAL(read)(kDescriptor.fd, &count, sizeof count));
  return kDescriptor.fd;
}

std::optional<ExecTime> earlier_of(std::optional<ExecTime> a, std::optional<ExecTime> b) {
  return a && b ? std::min(a, b) : a ? a : b;
}

}  // namespace

std::atomic<Agent*> Agent::instance_ = nullptr;
std::atomic<bool> Agent::finishes_ = false;

// The run is over, or cannot go on: so is the program. It says nothing that the coordinator does
// not know.
void Agent::end(const Failure& failure) {
  while (finishes_) ::pause();  // another thread ends the process, with what it has to write
  if (failure.kind != Failure::Kind::kRunEnded) say(failure.message);
  instance_.store(nullptr);
  TETHER_REAL(_exit)(failure.kind == Failure::Kind::kRunEnded ? 0 : 3);
  std::abort();
}

// Cameras that find no buffer for an image do not wake anybody.
bool Agent::receive_until(std::optional<ExecTime> until) {
  tell_if_idle();
  tell_if_beside();
  std::vector<std::string_view> sensors;
  for (const Camera& camera : cameras_.cameras())
    if (camera.has_room()) sensors.push_back(camera.sensor());
  if (port_.has_receiver()) sensors.push_back(receiver_);
  const Duration timeout = until ? std::max(Duration(0), *until - now()) : kForEver;
  const auto received =
      Unpaid::in_call([&] { return vehicle_->receive_or_measure(timeout, sensors, kTogether); });
  if (!received && received.failure().kind != Failure::Kind::kNothingYet) end(received.failure());
  if (!received) return false;
  if (received->empty()) take_measured();
  for (const client::RadioMessage& message : *received)
    if (message.from == link::kAutopilot) port_.deliver(message.bytes);
  return true;
}

void Agent::take_measured() {
  for (Camera& camera : cameras_.cameras()) camera.take_arrived();
  if (!port_.has_receiver()) return;
  const auto fix = Unpaid::in_call(
      [&] { return vehicle_->read<uav::NavSatSample>(receiver_, client::Read::kIfAvailable); });
  if (!fix) {
    if (fix.failure().kind != Failure::Kind::kNothingYet) end(fix.failure());
    return;
  }
  deliver(*fix);
}

void Agent::deliver(const uav::NavSatSample& fix) {
  const Duration at_utc = at_start(CLOCK_REALTIME) + (fix.sampled_at - SimTime{});
  const std::string text = nmea_of(fix, at_utc);
  port_.deliver_of_receiver({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// For all processes; this one hears of it on its line before the call returns.
void Agent::take_arrived() {
  if (is_stopped_) return hear_devices();
  if (group_) {
    tell_needs();
    listen();
    const auto nothing = vehicle().receive(Duration(0));
    if (!nothing && nothing.failure().kind != Failure::Kind::kNothingYet) end(nothing.failure());
    return;
  }
  with_cameras([this](CameraFiles&) {
    while (receive_until(now())) {
    }
    take_measured();
  });
}

void Agent::add_sensors() {
  for (const uav::SensorDescription& sensor : vehicle_->catalogue().sensors) {
    if (receiver_.empty() && sensor.rate_hz > 0.0 &&
        std::holds_alternative<uav::NavSatProperties>(sensor.properties))
      receiver_ = sensor.name,
      receiver_bit_ = std::uint64_t{1} << (&sensor - vehicle_->catalogue().sensors.data());
    const auto kind = sensor.camera_kind();
    if (!kind || !uav::has_color(*kind) || sensor.rate_hz <= 0.0) continue;
    hears_cameras_.try_emplace(sensor.name);
    cameras_.add(sensor, {.take = [this, name = sensor.name] { return take_image(name); },
                          .drop = [this, name = sensor.name](bool keeps) { drop(name, keeps); },
                          .now = [this] { return now(); }});
  }
}

std::optional<uav::CameraSample> Agent::take_image(const std::string& sensor) {
  if (is_stopped_) return std::exchange(arrived_, std::nullopt);
  auto image = Unpaid::in_call(
      [&] { return vehicle_->read<uav::CameraSample>(sensor, client::Read::kIfAvailable); });
  if (image) return std::move(*image);
  if (image.failure().kind != Failure::Kind::kNothingYet) end(image.failure());
  return std::nullopt;
}

// A driver keeps the oldest images, a queue the newest ones: so it has to be long.
void Agent::drop(const std::string& sensor, bool keeps_later_ones) {
  if (is_stopped_) return streams_change_.notify_all();
  static_cast<void>(vehicle_->set_queue(sensor, keeps_later_ones ? link::kMaxQueue : 1));
  const Status skipped = Unpaid::in_call([&] { return vehicle_->skip(sensor); });
  if (!skipped) end(skipped.failure());
}

void Agent::forget(int fd) {
  if (port_.is_line(fd)) {
    const std::lock_guard lock(stream_mutex_);
    streams_.erase(fd);
  }
  port_.forget(fd);
  timers_.forget(fd);
  if (is_camera(fd)) with_cameras([fd](CameraFiles& cameras) { cameras.forget(fd); });
}

void Agent::copy(int fd, int copy) {
  port_.copy(fd, copy);
  timers_.copy(fd, copy);
  if (is_camera(fd)) with_cameras([=](CameraFiles& cameras) { cameras.copy(fd, copy); });
}

bool Agent::send(std::span<const std::uint8_t> bytes) {
  const auto alone = leading();
  const Unpaid unpaid(*source_);
  const Status sent = Unpaid::in_call([&] { return vehicle().send(link::kAutopilot, bytes); });
  if (sent) return true;
  if (sent.failure().kind != Failure::Kind::kInvalid) end(sent.failure());
  return false;
}

void Agent::send_stream(int line, std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(stream_mutex_);
  streams_[line].add(bytes, [this](std::span<const std::uint8_t> frame) { send(frame); });
}

bool Agent::has_controller() {
  return std::ranges::count(vehicle().peers(), link::kAutopilot) > 0;
}

/// Of one wait: ET when it looked last, and how long it waited since.
struct Agent::Patience {
  ExecTime seen{};
  Duration slice = kShortestSlice;
};

// While ET goes on, another thread computes: until the deadline, if it does so all the time. While
// it stands, longer each time.
Duration Agent::slice(std::optional<ExecTime> deadline, Patience& patience) const {
  const ExecTime at = now();
  const auto real = [&](Duration of_et) {
    return Duration(
        static_cast<std::int64_t>(static_cast<double>(of_et.count()) / std::max(1.0, factor_)));
  };
  const bool stands = real(at - patience.seen) < patience.slice / 2;
  patience.seen = at;
  patience.slice = stands ? std::min(kLongestSlice, 2 * patience.slice) : kShortestSlice;
  if (stands || !deadline) return patience.slice;
  return std::clamp(real(*deadline - at), kShortestSlice, kLongestSlice);
}

Agent::Plan Agent::plan() {
  const std::lock_guard lock(waits_mutex_);
  Plan plan{!waits_.empty(), std::nullopt, waits_changes_};
  for (const Wait& wait : waits_) plan.first = earlier_of(plan.first, wait.deadline);
  plan.first = earlier_of(plan.first, timers_.next());
  plan.is_any |= timers_.next().has_value();
  return plan;
}

// Whether ET went on, or a message came. Nobody may be past its deadline: that one runs first. That
// all wait is only true of what they wait for if that is the same before and after: a thread may
// have ended one wait and begun another one.
bool Agent::lead() {
  const std::unique_lock lock(leading_, std::try_to_lock);
  if (!lock) return false;
  if (fire_timers()) return true;
  const Plan plan = this->plan();
  if (!plan.is_any || (plan.first && *plan.first <= now())) return false;
  if (!threads_.are_others_waiting() || wanting_ > 0 || !Signals::are_seen()) return false;
  if (this->plan() != plan) return false;
  receive_until(plan.first);
  fire_timers();
  wake_due();
  return true;
}

void Agent::wake_due() {
  constexpr std::uint64_t kOnce = 1;
  const std::lock_guard lock(waits_mutex_);
  for (const Wait& wait : waits_) {
    if (!wait.deadline || *wait.deadline > now()) continue;
    static_cast<void>(TETHER_REAL(write)(wait.wake, &kOnce, sizeof kOnce));
    if (group_ && wait.interrupt) wait.interrupt();
  }
}

std::list<Agent::Wait>::iterator Agent::enter(std::optional<ExecTime> deadline,
                                              std::function<void()> interrupt) {
  Wait wait{deadline, wake_of_thread(), std::move(interrupt)};
  if (group_) {
    listen();
    tell_needs();
    if (deadline) wait.shared = group_->page().begin_wait(process_, *deadline);
  }
  if (is_stopped_) hear_devices();
  const std::lock_guard lock(waits_mutex_);
  ++waits_changes_;
  return waits_.insert(waits_.end(), std::move(wait));
}

void Agent::tell_needs() {
  if (is_stopped_ ? timers_.next().has_value() : !group_ && timers_.have_events()) call_leader();
  if (!group_) return;
  client::GroupPage::Process& process = group_->process();
  if (timers_.next()) listen();  // it may wait in a way of its own for the signal of one
  process.timer = timers_.next().value_or(client::GroupPage::kNever);
  process.listens = port_.is_any();
  process.sensors = rooms_ | (port_.has_receiver() ? receiver_bit_.load() : 0);
}

// With leading_.
void Agent::tell_rooms() {
  if (!group_) return;
  const auto& sensors = vehicle_->catalogue().sensors;
  std::uint64_t rooms = 0;
  for (const Camera& camera : cameras_.cameras())
    if (camera.has_room())
      rooms |= std::uint64_t{1} << std::ranges::distance(
                   sensors.begin(),
                   std::ranges::find(sensors, camera.sensor(), &uav::SensorDescription::name));
  rooms_ = rooms;
  tell_needs();
}

void Agent::listen() {
  group_->listen([this](auto event, const auto& reply) { handle(event, reply); });
}

// On the thread that hears of it. What that wakes is at work when tether-exec hears that it was
// heard.
void Agent::handle(client::GroupEvent event, const link::Reply& reply) {
  const Unpaid unpaid(*source_);
  if (event == client::GroupEvent::kMessage && reply.message) port_.deliver(reply.message->bytes);
  if (event == client::GroupEvent::kMeasured)
    with_cameras([this](CameraFiles&) { take_measured(); });
  fire_timers();
  wake_due();
}

void Agent::leave(std::list<Wait>::iterator wait) {
  client::GroupPage::end_wait(wait->shared);
  const std::lock_guard lock(waits_mutex_);
  ++waits_changes_;
  waits_.erase(wait);
}

// With several threads, the leader's thread looks from time to time whether all wait.
Agent::End Agent::wait(std::optional<ExecTime> deadline, const std::function<bool()>& is_ready,
                       const Block& block) {
  const Unpaid unpaid(*source_);
  const unsigned handled = Signals::count();
  const auto own = enter(deadline);
  const bool is_alone = !Threads::are_several();
  Patience patience{.seen = now()};
  // What others compute during a call is charged with a CPU clock only.
  const bool hears = !is_alone && source_->clock().kind == computer::ClockKind::kCpu;
  ExecTime heard_at = patience.seen;
  End end = End::kReady;
  bool leads = true;
  const auto block_openly = [&](Duration slice) {
    const Unpaid::Paid paid(group_ != nullptr);
    const Signals::Open open(own->wake);
    if (Signals::count() == handled) block(slice, own->wake);
  };
  for (;;) {
    fire_timers();
    if (is_ready()) break;
    if (deadline && now() >= *deadline) end = End::kDeadline;
    if (end == End::kReady && Signals::have_run_since(handled)) end = End::kHandler;
    if (end != End::kReady) break;
    if (!group_) Unpaid::settle();
    if (group_) {
      block_openly(kLongestToldSlice);
      continue;
    }
    if (is_stopped_) {
      block_openly(real_until(earlier_of(deadline, timers_.next())));
      continue;
    }
    if (leads && lead()) continue;
    if (leads && !is_alone) call_leader();
    leads = is_alone;
    block_openly(slice(earlier_of(deadline, timers_.next()), patience));
    if (hears && is_fed() && now() - heard_at >= kBetweenLooks) {
      take_arrived();
      heard_at = now();
    }
  }
  leave(own);
  return end;
}

bool Agent::wait_for_thread(ExecTime deadline, const std::function<bool(Duration)>& wait_openly,
                            const std::function<void()>& interrupt) {
  const Unpaid unpaid(*source_);
  const auto block = [&](Duration slice) {
    const Unpaid::Paid paid(group_ != nullptr);
    const Signals::Open open;
    return wait_openly(slice);
  };
  // Of a group, a thread must not be found waiting, however shortly, before its deadline is known.
  if (!group_ && block(Duration(0))) return true;
  const auto own = enter(deadline, interrupt);
  if (!group_ && !is_stopped_) call_leader();
  Patience patience{.seen = now()};
  bool is_given = group_ && block(Duration(0));
  while (!is_given && now() < deadline) {
    if (!group_) Unpaid::settle();
    // Alone, nobody can wake it at its deadline.
    is_given = block(group_        ? kLongestToldSlice
                     : is_stopped_ ? real_until(deadline)
                                   : std::min(kLongestUnwoken, slice(deadline, patience)));
  }
  leave(own);
  return is_given;
}

void Agent::call_leader() {
  constexpr std::uint64_t kOnce = 1;
  std::call_once(leader_begins_, [this] {
    leader_wake_ = ::eventfd(0, EFD_CLOEXEC);
    Threads::began();  // from now on, the program is not alone with its time
    std::thread([this] { lead_for_others(); }).detach();
  });
  static_cast<void>(TETHER_REAL(write)(leader_wake_, &kOnce, sizeof kOnce));
}

// As long as somebody waits; then until somebody does.
void Agent::lead_for_others() {
  const Inside inside;
  ::pthread_setname_np(::pthread_self(), link::kClientThread);
  Patience patience;
  for (;;) {
    bool is_any = false;
    {
      const std::lock_guard lock(waits_mutex_);
      is_any = !waits_.empty() || timers_.next();
    }
    const Unpaid unpaid(*source_);
    if (!is_stopped_ && lead()) {
      patience = {};
      continue;
    }
    if (fire_timers()) {
      patience = {};
      continue;
    }
    if (is_stopped_) is_any = timers_.next().has_value();
    if (const auto next = timers_.next())
      patience.slice = std::max(kShortestSlice, std::min(patience.slice, real_until(next)));
    pollfd fd{leader_wake_, POLLIN, 0};
    const timespec time = to_timespec(patience.slice);
    Unpaid::settle();
    TETHER_REAL(ppoll)(&fd, 1, is_any ? &time : nullptr, nullptr);
    patience.slice = std::min(kLongestSlice, 2 * patience.slice);
    if (fd.revents == 0) continue;
    std::uint64_t count = 0;
    static_cast<void>(TETHER_REAL(read)(leader_wake_, &count, sizeof count));
    patience = {};
  }
}

bool Agent::is_here() const {
  return ::getpid() == process_;
}

bool Agent::sleep_until(ExecTime deadline) {
  const End end = wait(
      deadline, [] { return false; },
      [](Duration slice, int wake) {
        pollfd fd{wake, POLLIN, 0};
        const timespec time{0, static_cast<long>(slice.count())};
        TETHER_REAL(ppoll)(&fd, 1, &time, nullptr);
      });
  return end != End::kHandler;
}

void Agent::finish(int exit_code) {
  finishes_ = true;
  if (instance_.exchange(nullptr) == nullptr) return;
  // What it has computed is known from now on, however it ends.
  if (group_) return static_cast<void>(group_->page().used());
  if (is_stopped_ && !is_first()) return;
  const auto alone = leading();
  static_cast<void>(vehicle_->finish(
      exit_code == 0, "the program ended with exit code " + std::to_string(exit_code),
      client::details_of(Threads::computed())));
}

}  // namespace tether::as_is
