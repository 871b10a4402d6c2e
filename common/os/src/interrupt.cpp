#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <system_error>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/interrupt.h>
#include <tether/os/text_file.h>

// A signal handler may only make few calls: it passes the signal's number through a pipe to a
// thread, which requests the stop.
namespace tether::os {

namespace {

using Steady = std::chrono::steady_clock;

// Terminals and supervisors may send one interrupt twice in a row; a person's second one comes
// later.
constexpr auto kSameInterrupt = std::chrono::milliseconds(500);
constexpr char kEnd = 0;

volatile std::sig_atomic_t g_signals = -1;  // where the handler writes
Interrupt* g_interrupt = nullptr;

extern "C" void pass_on(int signal_number) {
  const int before = errno;
  const char byte = static_cast<char>(signal_number);
  [[maybe_unused]] const auto written = write(g_signals, &byte, 1);
  errno = before;
}

}  // namespace

Interrupt::Interrupt() : signals_(make_pipe()) {
  if (!signals_.write_end)
    throw Error(ErrorCode::kSetup, "cannot create a pipe for signals: " + reason_of(errno));
  start();
  g_interrupt = this;
  g_signals = signals_.write_end.get();
  struct sigaction action {};
  action.sa_handler = pass_on;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  ignores_hangup_ = std::signal(SIGHUP, SIG_IGN) == SIG_IGN;
  if (!ignores_hangup_) sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of file sizes then fails with an error
}

Interrupt::~Interrupt() {
  stop_catching();
  g_interrupt = nullptr;
  if (watcher_.joinable()) end_thread();
}

void Interrupt::stop_catching() const {
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  if (!ignores_hangup_) std::signal(SIGHUP, SIG_DFL);
}

// In a copy of the process, the thread has already ended.
Interrupt::Pause::Pause()
    : paused_(g_interrupt != nullptr && g_interrupt->watcher_.joinable() ? g_interrupt : nullptr) {
  if (paused_ != nullptr) paused_->end_thread();
}

Interrupt::Pause::~Pause() {
  if (paused_ == nullptr) return;
  try {
    paused_->start();
  } catch (const Error&) {
    paused_->stop_catching();
  }
}

Interrupt::EndsAtOnce::EndsAtOnce() : interrupt_(g_interrupt) {
  if (interrupt_ != nullptr) interrupt_->ends_at_once_ = true;
}

Interrupt::EndsAtOnce::~EndsAtOnce() {
  if (interrupt_ != nullptr) interrupt_->ends_at_once_ = false;
}

void Interrupt::start() try {
  watcher_ = std::thread([this] { watch(); });
} catch (const std::system_error& e) {
  throw Error(ErrorCode::kSetup,
              "cannot start a thread for signals: " + reason_of(e.code().value()));
}

void Interrupt::end_thread() {
  write_all(signals_.write_end, {&kEnd, 1});
  watcher_.join();
}

void Interrupt::watch() {
  for (char signal = 0;;) {
    const ssize_t got = read(signals_.read_end.get(), &signal, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got != 1 || signal == kEnd) return;
    stop_.request_stop();
    const bool is_second = signal != SIGHUP && first_ && Steady::now() - *first_ > kSameInterrupt;
    if (is_second || ends_at_once_) end_without_temporary_folders(128 + signal);
    if (signal == SIGHUP) continue;  // the kernel and the shell send one each, at any distance
    if (!first_) first_ = Steady::now();
  }
}

void sleep_unless_stopped(Duration limit, const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any wake;
  wake.wait_for(lock, stop, limit, [] { return false; });
}

}  // namespace tether::os
