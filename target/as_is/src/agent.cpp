#include "agent.h"

#include "beside_source.h"
#include "clocks.h"
#include "nmea.h"
#include "real.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <tether/link/messages.h>
#include <tether/os/clock.h>

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
// After so long it is told that nothing was used [ET].
constexpr Duration kIdle = std::chrono::seconds(10);
// Of a wait without a deadline; then it begins again.
constexpr Duration kForEver = std::chrono::hours(1);

void say(const std::string& line) {
  std::fprintf(stderr, "tether: %s\n", line.c_str());
}

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

/// The program's own name: the last part of its path.
std::string program_name() {
  char path[4096];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
  const std::string whole(path, size > 0 ? static_cast<std::size_t>(size) : 0);
  return whole.substr(whole.rfind('/') + 1);
}

}  // namespace

thread_local int Inside::depth_ = 0;
thread_local Unpaid* Unpaid::current_ = nullptr;
std::atomic<Agent*> Agent::instance_ = nullptr;

Agent::Agent(std::unique_ptr<GroupMember> group)
    : group_(std::move(group)),
      group_source_(client::make_group_source(group_->page(), 1.0)),
      source_(group_source_.get()),
      factor_(1.0),
      process_(::getpid()) {
  Unpaid::clock_stands_in_calls = false;
}

void Agent::start_in_group() {
  if (auto member = GroupMember::of_environment())
    instance_.store(new Agent(std::move(member)), std::memory_order_release);
}

void Agent::leave() {
  const Inside inside;
  const Agent* const parent = instance_.exchange(nullptr);
  if (parent == nullptr || !parent->group_) return;
  if (auto member = GroupMember::of_child(*parent->group_))
    instance_.store(new Agent(std::move(member)), std::memory_order_release);
}

client::Vehicle& Agent::vehicle() {
  if (group_)
    std::call_once(connects_, [this] {
      client::ConnectOptions options;
      options.exec_socket = group_->socket();
      options.sut_name = program_name();
      auto vehicle = client::connect(std::move(options));
      if (!vehicle) end(vehicle.failure());
      vehicle_ = std::move(*vehicle);
      add_sensors();
    });
  return *vehicle_;
}

void Agent::start() {
  const Inside inside;
  if (const char* kind = std::getenv("TETHER_AS_IS"); kind && std::string_view(kind) == "group")
    return start_in_group();
  auto options = client::options_from_environment();
  if (!options) return say(options.failure().message + "; the program runs by itself");
  options->sut_name = program_name();
  if (options->time) options->time = charge_beside_calls(std::move(options->time));
  client::TimeSource* const source = options->time.get();
  auto vehicle = client::connect(std::move(*options));
  if (!vehicle) {
    say(vehicle.failure().message);
    ::_exit(3);
  }
  auto* const agent = new Agent(std::move(*vehicle), *source);
  agent->process_ = ::getpid();
  instance_.store(agent, std::memory_order_release);
}

// The run is over, or cannot go on: so is the program. It says nothing that the coordinator does
// not know.
void Agent::end(const Failure& failure) {
  if (failure.kind != Failure::Kind::kRunEnded) say(failure.message);
  instance_.store(nullptr);
  TETHER_REAL(_exit)(failure.kind == Failure::Kind::kRunEnded ? 0 : 3);
  std::abort();
}

// A program that uses some of it is right: it need not use all.
void Agent::tell_if_idle() {
  if (is_known_to_be_used_) return;
  is_known_to_be_used_ = is_fed();
  if (is_known_to_be_used_ || now() < ExecTime(kIdle)) return;
  is_known_to_be_used_ = true;
  say("for 10 s the program has used nothing of the UAV: no UDP port of a companion (14540, "
      "14550), "
      "no serial port, and none of its cameras, of which it has " +
      std::to_string(cameras_.cameras().size()));
}

// Cameras that find no buffer for an image do not wake anybody.
bool Agent::receive_until(std::optional<ExecTime> until) {
  tell_if_idle();
  std::vector<std::string_view> sensors;
  for (const Camera& camera : cameras_.cameras())
    if (camera.has_room()) sensors.push_back(camera.sensor());
  if (port_.has_receiver()) sensors.push_back(receiver_);
  const Duration timeout = until ? std::max(Duration(0), *until - now()) : kForEver;
  const auto received =
      Unpaid::in_call([&] { return vehicle_->receive_or_measure(timeout, sensors); });
  if (!received && received.failure().kind != Failure::Kind::kNothingYet) end(received.failure());
  if (received && *received && (*received)->from == link::kAutopilot)
    port_.deliver((*received)->bytes);
  if (received && !*received) take_measured();
  return received.ok();
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
  const Duration at_utc = at_start(CLOCK_REALTIME) + (fix->sampled_at - SimTime{});
  const std::string text = nmea_of(*fix, at_utc);
  port_.deliver_of_receiver({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// For all processes; this one hears of it on its line before the call returns.
void Agent::take_arrived() {
  if (group_) {
    tell_needs();
    group_->listen([this](auto event, const auto& reply) { handle(event, reply); });
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
    cameras_.add(sensor, {.take = [this, name = sensor.name] { return take_image(name); },
                          .drop = [this, name = sensor.name](bool keeps) { drop(name, keeps); },
                          .now = [this] { return now(); }});
  }
}

std::optional<uav::CameraSample> Agent::take_image(const std::string& sensor) {
  auto image = Unpaid::in_call(
      [&] { return vehicle_->read<uav::CameraSample>(sensor, client::Read::kIfAvailable); });
  if (image) return std::move(*image);
  if (image.failure().kind != Failure::Kind::kNothingYet) end(image.failure());
  return std::nullopt;
}

// A driver keeps the oldest images, a queue the newest ones: so it has to be long.
void Agent::drop(const std::string& sensor, bool keeps_later_ones) {
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
  const std::lock_guard leading(leading_);
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

// Whether ET went on, or a message came. Nobody may be past its deadline: that one runs first.
bool Agent::lead() {
  const std::unique_lock leading(leading_, std::try_to_lock);
  if (!leading || !threads_.are_others_waiting()) return false;
  if (fire_timers()) return true;
  std::optional<ExecTime> earliest = timers_.next();
  bool is_empty = true;
  {
    const std::lock_guard lock(waits_mutex_);
    is_empty = waits_.empty();
    for (const auto& [deadline, wake, interrupt, shared] : waits_)
      if (deadline) earliest = std::min(earliest.value_or(*deadline), *deadline);
  }
  if (is_empty || (earliest && *earliest <= now())) return false;
  receive_until(earliest);
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
    group_->listen([this](auto event, const auto& reply) { handle(event, reply); });
    tell_needs();
    if (deadline) wait.shared = group_->page().begin_wait(process_, *deadline);
  }
  const std::lock_guard lock(waits_mutex_);
  return waits_.insert(waits_.end(), std::move(wait));
}

void Agent::tell_needs() {
  if (!group_) return;
  client::GroupPage::Process& process = group_->process();
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
  waits_.erase(wait);
}

// With several threads, the leader's thread looks from time to time whether all wait.
bool Agent::wait(std::optional<ExecTime> deadline, const std::function<bool()>& is_ready,
                 const Block& block) {
  const Unpaid unpaid(*source_);
  const auto own = enter(deadline);
  const bool is_alone = !Threads::are_several();
  Patience patience{.seen = now()};
  // What others compute during a call is charged with a CPU clock only.
  const bool hears = !is_alone && source_->clock().kind == computer::ClockKind::kCpu;
  ExecTime heard_at = patience.seen;
  bool ready = false;
  bool leads = true;
  for (;;) {
    fire_timers();
    if ((ready = is_ready()) || (deadline && now() >= *deadline)) break;
    Unpaid::settle();
    if (group_) {
      block(kLongestToldSlice, own->wake);
      continue;
    }
    if (leads && lead()) continue;
    if (leads && !is_alone) call_leader();
    leads = is_alone;
    block(slice(earlier_of(deadline, timers_.next()), patience), own->wake);
    if (hears && is_fed() && now() - heard_at >= kBetweenLooks) {
      take_arrived();
      heard_at = now();
    }
  }
  leave(own);
  return ready;
}

bool Agent::wait_for_thread(ExecTime deadline, const std::function<bool(Duration)>& block,
                            const std::function<void()>& interrupt) {
  const Unpaid unpaid(*source_);
  // Of a group, a thread must not be found waiting, however shortly, before its deadline is known.
  if (!group_ && block(Duration(0))) return true;
  const auto own = enter(deadline, interrupt);
  if (!group_) call_leader();
  Patience patience{.seen = now()};
  bool is_given = group_ && block(Duration(0));
  while (!is_given && now() < deadline) {
    Unpaid::settle();
    // Alone, nobody can wake it at its deadline.
    is_given =
        block(group_ ? kLongestToldSlice : std::min(kLongestUnwoken, slice(deadline, patience)));
  }
  leave(own);
  return is_given;
}

void Agent::call_leader() {
  constexpr std::uint64_t kOnce = 1;
  std::call_once(leader_begins_, [this] {
    leader_wake_ = ::eventfd(0, EFD_CLOEXEC);
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
      is_any = !waits_.empty();
    }
    const Unpaid unpaid(*source_);
    if (lead()) {
      patience = {};
      continue;
    }
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

void Agent::sleep_until(ExecTime deadline) {
  wait(
      deadline, [] { return false; },
      [](Duration slice, int wake) {
        pollfd fd{wake, POLLIN, 0};
        const timespec time{0, static_cast<long>(slice.count())};
        TETHER_REAL(ppoll)(&fd, 1, &time, nullptr);
      });
}

bool Agent::tell(const std::string& line) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  const bool is_new = told.insert(line).second;
  if (is_new) say(line);
  return is_new;
}

void Agent::tell_gap(const char* what) {
  if (!tell(std::string("the program uses ") + what +
            ", which follows the machine's clock: its time is not that of the run"))
    return;
  const std::lock_guard leading(leading_);
  static_cast<void>(
      vehicle().annotate("as_is", std::string("{\"not_covered\": \"") + what + "\"}"));
}

void Agent::finish(int exit_code) {
  if (instance_.exchange(nullptr) == nullptr) return;
  // What it has computed is known from now on, however it ends.
  if (group_) return static_cast<void>(group_->page().used());
  const std::lock_guard leading(leading_);
  static_cast<void>(vehicle_->finish(
      exit_code == 0, "the program ended with exit code " + std::to_string(exit_code), "{}"));
}

}  // namespace tether::as_is
