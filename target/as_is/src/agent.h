#pragma once

#include "camera/camera_files.h"
#include "group_member.h"
#include "port.h"
#include "serial.h"
#include "threads.h"
#include "timers.h"
#include "unpaid.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <sys/socket.h>
#include <sys/types.h>

#include <tether/base/time.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::as_is {

/// To the user, on standard error.
void say(const std::string& line);
/// The last part of the path of this process's program.
std::string program_name();

/// The program's side of the run: its clock is ET, and its waits are interactions
/// (docs/guide/as-is.md). One for each process that is under test. Its functions are called by
/// threads that are Inside.
///
/// A wait registers its deadline. When all threads of the program wait, one leads: it asks the
/// coordinator for what comes first, a message of the flight controller or the earliest deadline,
/// and ET goes on from there. A thread that waits for another one cannot lead, because it has to
/// hear that one all the time; a thread of this library does it for them. The messages are put into
/// the program's own sockets, and what its timers count into its own descriptors, so that the
/// kernel wakes whoever waits for them.
///
/// Under tether-exec with the wall clock, the program is *stopped* while the simulation catches up
/// (ADR 0096). Then nobody leads: waits take real time, and what arrives is heard by threads of
/// this library, one for each device that the program uses.
///
/// Thread-safe.
class Agent {
 public:
  struct Wait {
    std::optional<ExecTime> deadline;
    int wake;  // an eventfd of its thread
    /// Wakes a thread that waits for another one, in which case there is no descriptor.
    std::function<void()> interrupt{};
    client::GroupPage::Wait* shared = nullptr;
  };

  /// nullptr: this process is not under test, or no more.
  static Agent* get() { return instance_.load(std::memory_order_acquire); }
  /// Connects, as the environment says. Ends the process, with a line, if it cannot.
  static void start();

  /// In a forked child: it is not under test, and has the machine's clocks; or it is one more
  /// process of the program.
  static void leave();

  ExecTime now() const {
    if (!group_) return clock_->now();
    Unpaid::settle();  // what it fixes is paid
    return group_->page().now();
  }
  /// Of a group: there will be one more thread of the program. nullptr: nobody has to know.
  client::GroupPage::Thread* thread_begins() const {
    return group_ ? group_->page().begin_thread(process_, client::GroupPage::kBegins) : nullptr;
  }
  /// Whether the program's processes share one execution time, and jump over their waits together.
  bool is_in_group() const { return group_ != nullptr; }
  /// Whether it is stopped while the simulation catches up.
  bool is_stopped() const { return is_stopped_; }

  /// Waits until `is_ready`, or the deadline (none: for ever). `block` waits for the same in real
  /// time, for at most so long, and if it can until the descriptor can be read.
  using Block = std::function<void(Duration slice, int wake)>;
  enum class End { kReady, kDeadline, kHandler };  // a handler of a signal has run
  End wait(std::optional<ExecTime> deadline, const std::function<bool()>& is_ready,
           const Block& block);
  /// The same for what another thread of the program gives; `block` returns whether it has.
  /// `interrupt` ends `block`, or does nothing if it has not begun.
  bool wait_for_thread(ExecTime deadline, const std::function<bool(Duration)>& block,
                       const std::function<void()>& interrupt);
  /// False: a handler of a signal has run.
  bool sleep_until(ExecTime deadline);
  /// Puts what has arrived up to now into the program's sockets.
  void take_arrived();

  Port& port() { return port_; }
  /// To the flight controller. False: the UAV has none.
  bool send(std::span<const std::uint8_t> bytes);

  /// The same, from a stream of frames: that of a line's descriptor.
  void send_stream(int line, std::span<const std::uint8_t> bytes);
  bool has_controller();
  /// Of satellite navigation, with a rate of its own.
  bool has_receiver() {
    vehicle();
    return !receiver_.empty();
  }

  bool is_camera(int fd) const { return cameras_.is_ours(fd); }
  bool has_camera(unsigned number) {
    vehicle();
    return number < cameras_.cameras().size();
  }
  /// What the functions of CameraFiles do, one at a time.
  template <class Call>
  auto with_cameras(Call call) {
    const auto alone = leading();
    const Unpaid unpaid(*source_);
    const ToldNeeds told(*this);
    return call(cameras_);
  }
  /// Whether something can arrive for the program.
  bool is_fed() const { return port_.is_any() || cameras_.is_any(); }

  Timers& timers() { return timers_; }
  /// Those of the timers that are due up to now. False: none is.
  bool fire_timers() {
    const bool is_any = timers_.next() && timers_.fire(now());
    if (is_any) tell_needs();
    return is_any;
  }
  /// To tether-exec, if that leads for all processes: what this one waits for besides deadlines.
  void tell_needs();

  /// A descriptor is closed, or there is another one of the same.
  void forget(int fd);
  void copy(int fd, int copy);

  /// The program uses something that this library does not bring to ET: says so, once for each, and
  /// the answer does.
  void tell_gap(const char* what);
  /// It talks to another computer, or to a program that is not under test: these have the real
  /// time.
  void tell_outside(const sockaddr* address);
  /// Of a group: it is about to wait for a lock of this file.
  void tell_locked(int fd);
  /// Says something, once. False: it was said before.
  static bool tell(const std::string& line);

  /// Whether the caller is in this process, and not in a child that shares its memory (vfork).
  bool is_here() const;
  /// Of a program that is stopped: whether this process is the one that tether-exec started.
  bool is_first() const;
  /// The program ends with this code.
  void finish(int exit_code);

 private:
  Agent(std::unique_ptr<client::Vehicle> vehicle, client::TimeSource& source)
      : vehicle_(std::move(vehicle)),
        source_(&source),
        factor_(source.clock().factor),
        clock_(vehicle_.get()) {
    add_sensors();
  }
  explicit Agent(std::unique_ptr<GroupMember> group);
  /// One that is stopped. `clock`: of the process that forked this one; nullptr: it has its own.
  explicit Agent(const client::Vehicle* clock);
  static void start_in_group();
  /// Of several processes, connected when it is used first.
  client::Vehicle& vehicle();
  Result<std::unique_ptr<client::Vehicle>> connect_to_exec() const;
  /// Of one that is stopped: hears what arrives at the devices that the program has opened.
  void hear_devices();
  template <class Hear>
  void hear(std::once_flag& begins, Hear hear);
  void hear_camera(Camera& camera);
  Duration real_until(std::optional<ExecTime> until) const;
  /// Of a group: hears what tether-exec tells this process.
  void listen();
  void handle(client::GroupEvent event, const link::Reply& reply);
  void tell_rooms();
  /// With leading_. A thread of the program that waits for it does not wait for time: who leads
  /// must see that.
  std::unique_lock<std::mutex> leading() {
    ++wanting_;
    std::unique_lock lock(leading_);
    --wanting_;
    return lock;
  }
  struct ToldNeeds {
    explicit ToldNeeds(Agent& agent) : agent_(agent) {}
    ~ToldNeeds() { agent_.tell_rooms(); }
    ToldNeeds(const ToldNeeds&) = delete;
    ToldNeeds& operator=(const ToldNeeds&) = delete;
    Agent& agent_;
  };
  /// Takes the next messages, or lets ET reach that instant.
  bool receive_until(std::optional<ExecTime> until);
  void tell_if_idle();
  void tell_if_beside();
  void doubt(const std::string& text);
  void doubt_once(const std::string& text);
  std::vector<pid_t> all_processes() const;
  struct Patience;
  /// What all wait for: none, if nobody waits, or the first instant.
  struct Plan {
    bool is_any = false;
    std::optional<ExecTime> first{};
    unsigned changes = 0;

    bool operator==(const Plan&) const = default;
  };
  Plan plan();
  bool lead();
  void add_sensors();
  void take_measured();
  void deliver(const uav::NavSatSample& fix);
  std::optional<uav::CameraSample> take_image(const std::string& sensor);
  void drop(const std::string& sensor, bool keeps_later_ones);
  [[noreturn]] void lead_for_others();
  std::list<Wait>::iterator enter(std::optional<ExecTime> deadline,
                                  std::function<void()> interrupt = {});
  void leave(std::list<Wait>::iterator wait);
  void wake_due();
  Duration slice(std::optional<ExecTime> deadline, Patience& patience) const;
  void call_leader();
  [[noreturn]] static void end(const Failure& failure);

  static std::atomic<Agent*> instance_;
  static std::atomic<bool> finishes_;

  std::unique_ptr<GroupMember> group_;              // none: the program has one process
  std::unique_ptr<client::TimeSource> own_source_;  // of the two below
  std::once_flag connects_;
  // Bits of sensors: cameras that have room, and the receiver.
  std::atomic<std::uint64_t> rooms_{0}, receiver_bit_{0};
  std::unique_ptr<client::Vehicle> vehicle_;
  client::TimeSource* source_;  // of the vehicle, or the group
  double factor_;               // ET per CPU time, or wall time
  bool is_known_to_be_used_ = false, is_known_to_be_beside_ = false;
  Port port_;
  CameraFiles cameras_;     // with leading_
  std::string receiver_{};  // the sensor; empty: none
  Timers timers_{start_thread};
  std::mutex stream_mutex_;
  std::map<int, FrameStream> streams_;
  Threads threads_;
  std::mutex leading_;
  std::mutex waits_mutex_;
  std::list<Wait> waits_;
  unsigned waits_changes_ = 0;    // with waits_mutex_
  std::atomic<int> wanting_ = 0;  // threads of the program that wait for leading_
  std::once_flag leader_begins_;
  int leader_wake_ = -1;  // an eventfd: somebody begins to wait
  pid_t process_ = 0;
  bool is_stopped_ = false;
  const client::Vehicle* clock_ = nullptr;
  std::once_flag hears_controller_, hears_receiver_;
  std::map<std::string, std::once_flag> hears_cameras_;
  std::condition_variable streams_change_;      // with leading_
  std::optional<uav::CameraSample> arrived_{};  // with leading_
};

}  // namespace tether::as_is
