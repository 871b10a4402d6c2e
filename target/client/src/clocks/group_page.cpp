#include "clocks/descendants.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/client/exec/group_page.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/machine.h>

namespace tether::client {
namespace {

constexpr int kMostTellings = 3;

template <class T>
T raise_to(std::atomic<T>& latest, T value) {
  T before = latest.load();
  while (before < value && !latest.compare_exchange_weak(before, value)) {
  }
  return std::max(before, value);
}

/// Raises `end` above an index.
void reach(std::atomic<std::size_t>& end, std::size_t index) {
  raise_to(end, index + 1);
}

Duration times_factor(Duration used, double factor) {
  return Duration(std::llround(static_cast<double>(used.count()) * factor));
}

Failure not_shared(const std::string& file) {
  return {Failure::Kind::kInvalid, "cannot share the memory of the program's processes, " + file +
                                       ": " + std::strerror(errno)};
}

Result<void*> map(const std::string& file, int flags) {
  const os::FileDescriptor descriptor(::open(file.c_str(), flags | O_RDWR | O_CLOEXEC, 0600));
  struct stat status {};
  if (!descriptor) return not_shared(file);
  // With its memory: on a full disk, writing to it would end the process.
  if ((flags & O_CREAT) != 0)
    if (const int error = ::posix_fallocate(descriptor.get(), 0, sizeof(GroupPage)); error != 0) {
      errno = error;
      return not_shared(file);
    }
  if (::fstat(descriptor.get(), &status) != 0 || status.st_size != off_t{sizeof(GroupPage)})
    return Failure{
        Failure::Kind::kInvalid,
        file + " has another size. Use a tether-exec of the same version as its library"};
  void* const memory =
      ::mmap(nullptr, sizeof(GroupPage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
  if (memory == MAP_FAILED) return not_shared(file);
  return memory;
}

/// Of this process, when the calling thread began to compute what it leaves out.
thread_local Duration t_process_at_begin __attribute__((tls_model("initial-exec"))){0};

class GroupSource final : public TimeSource {
 public:
  GroupSource(GroupPage& page, double factor, GroupPage::Process* own, const Computed* ended)
      : page_(page), factor_(factor), own_(own), ended_(ended) {}

  computer::Clock clock() const override { return {computer::ClockKind::kCpu, factor_}; }
  Duration elapsed() const override { return last_ = times_factor(page_.used(), factor_); }
  // Of the same instant: what is computed between two looks would be charged never, or twice.
  Duration elapsed_in_children() const override { return last_; }
  Computed computed_by_parts() const override {
    Computed parts;
    if (ended_ == nullptr) return parts;
    parts = *ended_;
    page_.add_present(parts);
    return parts;
  }
  Duration counted_of_thread() const override { return os::read_clock(CLOCK_THREAD_CPUTIME_ID); }
  Duration begin_to_leave_out() override {
    t_process_at_begin = os::read_clock(CLOCK_PROCESS_CPUTIME_ID);
    return counted_of_thread();
  }
  void leave_out(Duration computed) override {
    if (own_ == nullptr) return;
    const Duration of_all = os::read_clock(CLOCK_PROCESS_CPUTIME_ID) - t_process_at_begin;
    page_.leave_out(*own_, computed, of_all - computed);
  }

 private:
  GroupPage& page_;
  double factor_;
  GroupPage::Process* own_;
  const Computed* ended_;
  mutable std::atomic<Duration> last_{Duration(0)};
};

}  // namespace

GroupPage::Process* GroupPage::enter(pid_t process) {
  for (Process& one : processes_)
    if (one.id == process) return &one;
  constexpr pid_t kTaken = -1;
  for (std::size_t i = 0; i < kProcesses; ++i) {
    pid_t free = 0;
    if (!processes_[i].id.compare_exchange_strong(free, kTaken)) continue;
    processes_[i].used_ns = 0;
    processes_[i].fixed_ns = 0;
    processes_[i].timer = kNever;
    processes_[i].sensors = 0;
    processes_[i].listens = false;
    processes_[i].unseen = 0;
    processes_[i].id = process;
    reach(processes_end_, i);
    begin_thread(process, process);
    return &processes_[i];
  }
  return nullptr;
}

bool GroupPage::has(pid_t process) const {
  for (std::size_t i = 0; i < processes_end_; ++i)
    if (processes_[i].id == process) return true;
  return false;
}

GroupPage::Thread* GroupPage::begin_thread(pid_t process, pid_t id) {
  constexpr pid_t kTaken = -2;
  for (std::size_t i = 0; i < kThreads; ++i) {
    pid_t free = 0;
    if (threads_[i].id != 0 || !threads_[i].id.compare_exchange_strong(free, kTaken)) continue;
    threads_[i].process = process;
    threads_[i].id = id;
    reach(threads_end_, i);
    return &threads_[i];
  }
  return nullptr;
}

void GroupPage::end_thread(Thread* thread) {
  if (thread != nullptr) thread->id = 0;
}

void GroupPage::begin_again(pid_t process) {
  for (std::size_t i = 0; i < processes_end_; ++i)
    if (processes_[i].id == process) processes_[i].unseen = 0;
  for (Thread& thread : threads())
    if (thread.process == process && thread.id != process && thread.id != 0) end_thread(&thread);
  for (std::size_t i = 0; i < waits_end_; ++i) {
    pid_t own = process;
    waits_[i].process.compare_exchange_strong(own, 0);
  }
}

void GroupPage::Process::call(std::string_view text) {
  for (std::size_t i = 0; i < name.size(); ++i)
    name[i] = i < text.size() && i + 1 < name.size() ? text[i] : '\0';
}

std::string GroupPage::Process::called() const {
  std::string text;
  for (const auto& one : name)
    if (const char c = one; c != '\0') text += c;
  return text;
}

void GroupPage::add_present(Computed& computed) const {
  for (std::size_t i = 0; i < processes_end_; ++i)
    if (const Process& one = processes_[i]; one.id > 0)
      computed[one.called()] += Duration(one.used_ns);
}

void GroupPage::forget_ended(Computed& computed) {
  for (std::size_t i = 0; i < processes_end_; ++i) {
    Process& one = processes_[i];
    const pid_t id = one.id;
    if (id <= 0 || used_by_process(id)) continue;
    begin_again(id);
    ++moves_;
    ended_ns_ += one.used_ns;
    computed[one.called()] += Duration(one.used_ns);
    one.id = 0;
    ++moves_;
  }
}

Duration GroupPage::used() const {
  const Duration each = used_by_each(Looks::kFixes);
  return Duration(raise_to(latest_used_ns_, each.count() - left_out_ns_));
}

// Who reads used() while this is decided may have had it.
void GroupPage::leave_out(Process& own, Duration computed, Duration beside) {
  const std::int64_t fixed_ns = own.fixed_ns;
  const Duration unfixed = used_by_process(own.id).value_or(Duration(0)) - Duration(fixed_ns);
  const Duration most = std::min(computed, unfixed - std::max(beside, Duration(0)));
  if (most <= Duration(0)) return;
  left_out_ns_ += most.count();
  if (own.fixed_ns != fixed_ns) left_out_ns_ -= most.count();
}

Duration GroupPage::used_by_each(Looks looks) const {
  for (;;) {
    const std::uint32_t moves = moves_;
    std::int64_t sum_ns = ended_ns_;
    for (std::size_t i = 0; i < processes_end_; ++i) {
      Process& one = processes_[i];
      const pid_t id = one.id;
      if (id <= 0) continue;
      const auto used = used_by_process(id);
      const std::int64_t now_ns =
          used ? raise_to(one.used_ns, std::int64_t{used->count()}) : one.used_ns.load();
      if (looks == Looks::kFixes) raise_to(one.fixed_ns, now_ns);
      sum_ns += now_ns;
    }
    if (moves % 2 == 0 && moves_ == moves) return Duration(sum_ns);
  }
}

void GroupPage::publish(ExecTime at, Duration used, double factor) {
  ++courses_;
  base_et_ = at;
  base_used_ns_ = used.count();
  factor_ = factor;
  ++courses_;
}

ExecTime GroupPage::now() const {
  return raise_to(latest_, course_at(used()));
}

ExecTime GroupPage::glance() const {
  return std::max(latest_.load(),
                  course_at(used_by_each(Looks::kGlances) - Duration(left_out_ns_)));
}

ExecTime GroupPage::course_at(Duration used) const {
  for (;;) {
    const std::uint32_t courses = courses_;
    const ExecTime at =
        base_et_.load() +
        times_factor(std::max(used - Duration(base_used_ns_), Duration(0)), factor_);
    if (courses % 2 == 0 && courses_ == courses) return at;
  }
}

GroupPage::Wait* GroupPage::begin_wait(pid_t process, ExecTime deadline) {
  for (std::size_t i = 0; i < kWaits; ++i) {
    pid_t free = 0;
    if (waits_[i].process != 0) continue;
    // Nobody sees the deadline before.
    constexpr pid_t kTaken = -1;
    if (!waits_[i].process.compare_exchange_strong(free, kTaken)) continue;
    waits_[i].deadline = deadline;
    waits_[i].told_at = Duration(0);
    waits_[i].tellings = 0;
    waits_[i].process = process;
    reach(waits_end_, i);
    return &waits_[i];
  }
  return nullptr;
}

void GroupPage::end_wait(Wait* wait) {
  if (wait != nullptr) wait->process = 0;
}

ExecTime GroupPage::first_deadline() const {
  ExecTime first = kNever;
  for (std::size_t i = 0; i < waits_end_; ++i)
    if (waits_[i].process > 0 && waits_[i].tellings < kMostTellings)
      first = std::min(first, waits_[i].deadline.load());
  for (std::size_t i = 0; i < processes_end_; ++i)
    if (processes_[i].id > 0) first = std::min(first, processes_[i].timer.load());
  return first;
}

bool GroupPage::tell_overdue(pid_t process, ExecTime now, Duration since, Duration told_at) {
  bool is_any = false;
  for (std::size_t i = 0; i < waits_end_; ++i) {
    Wait& wait = waits_[i];
    if (wait.process != process || wait.deadline.load() > now || wait.told_at.load() > since)
      continue;
    wait.told_at = told_at;
    is_any |= wait.tellings++ < kMostTellings;
  }
  for (std::size_t i = 0; i < processes_end_; ++i)
    is_any |= processes_[i].id == process && processes_[i].timer.load() <= now;
  return is_any;
}

void UnmapGroupPage::operator()(GroupPage* mapped) const {
  ::munmap(mapped, sizeof(GroupPage));
}

Result<MappedGroupPage> make_group_page(const std::string& file) {
  const auto memory = map(file, O_CREAT | O_EXCL);
  if (!memory) return memory.failure();
  return MappedGroupPage(new (*memory) GroupPage);
}

Result<MappedGroupPage> map_group_page(const std::string& file) {
  const auto memory = map(file, 0);
  if (!memory) return memory.failure();
  return MappedGroupPage(static_cast<GroupPage*>(*memory));
}

std::string group_page_beside(std::string_view exec_socket) {
  return std::string(exec_socket.substr(0, exec_socket.rfind('/') + 1)) + "page";
}

std::unique_ptr<TimeSource> make_group_source(GroupPage& page, double factor,
                                              GroupPage::Process* own, const Computed* ended) {
  return std::make_unique<GroupSource>(page, factor, own, ended);
}

}  // namespace tether::client
