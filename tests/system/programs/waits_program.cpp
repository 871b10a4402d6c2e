// A program that knows nothing of Tether: waits for 20 ms in each way that there is, and prints how
// long that took by MONOTONIC and REALTIME [µs].
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <future>
#include <mutex>
#include <semaphore>
#include <thread>

#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <threads.h>
#include <unistd.h>

namespace {

using namespace std::chrono_literals;

constexpr long kWait_ns = 20'000'000;

long us(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<long>(t.tv_sec) * 1'000'000 + t.tv_nsec / 1000;
}

timespec later(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  t.tv_nsec += kWait_ns;
  if (t.tv_nsec >= 1'000'000'000) {
    t.tv_nsec -= 1'000'000'000;
    ++t.tv_sec;
  }
  return t;
}

void take(const char* name, const std::function<void()>& wait) {
  const long monotonic = us(CLOCK_MONOTONIC), real = us(CLOCK_REALTIME);
  wait();
  std::printf("%s %ld %ld\n", name, us(CLOCK_MONOTONIC) - monotonic, us(CLOCK_REALTIME) - real);
}

volatile std::sig_atomic_t g_alarms = 0;
sem_t g_expired;

// Timers that send signals, or start threads, while the program waits in each way, or computes.
void wait_for_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_alarms = g_alarms + 1; };
  sigaction(SIGALRM, &action, nullptr);
  const itimerval once{{}, {0, kWait_ns / 1000}};
  const timespec second{1, 0};
  const auto alarmed = [&](const char* name, const std::function<void()>& wait) {
    take(name, [&] {
      g_alarms = 0;
      setitimer(ITIMER_REAL, &once, nullptr);
      wait();
      if (g_alarms != 1) std::printf("alarms_of_%s %d 0\n", name, static_cast<int>(g_alarms));
    });
  };
  alarmed("alarm_pause", [] { pause(); });
  alarmed("alarm_sleep", [&] { nanosleep(&second, nullptr); });
  alarmed("alarm_poll", [] { poll(nullptr, 0, 1000); });
  alarmed("alarm_semaphore", [&] {
    const timespec until{later(CLOCK_REALTIME).tv_sec + 1, 0};
    sem_timedwait(&g_expired, &until);
  });
  alarmed("alarm_computing", [] {
    while (g_alarms == 0) {
    }
  });
  sigset_t expiry;
  sigemptyset(&expiry);
  sigaddset(&expiry, SIGRTMIN);
  sigprocmask(SIG_BLOCK, &expiry, nullptr);
  const timespec duration{0, kWait_ns};
  take("sigtimedwait", [&] { sigtimedwait(&expiry, nullptr, &duration); });

  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGRTMIN;
  timer_t timer{};
  timer_create(CLOCK_MONOTONIC, &event, &timer);
  const itimerspec quarters{{0, kWait_ns / 4}, {0, kWait_ns / 4}}, never{};
  take("timer_sigtimedwait", [&] {
    timer_settime(timer, 0, &quarters, nullptr);
    for (int periods = 0; periods < 4; periods += 1 + timer_getoverrun(timer))
      if (sigtimedwait(&expiry, nullptr, &second) != SIGRTMIN) break;
  });
  timer_settime(timer, 0, &never, nullptr);
  timer_delete(timer);
  event.sigev_signo = SIGALRM;
  event.sigev_notify = SIGEV_THREAD_ID;
  event._sigev_un._tid = gettid();
  timer_create(CLOCK_REALTIME, &event, &timer);
  take("timer_thread_id", [&] {
    const itimerspec at{{}, later(CLOCK_REALTIME)};
    timer_settime(timer, TIMER_ABSTIME, &at, nullptr);
    pause();
  });
  timer_delete(timer);
  sigevent starts{};
  starts.sigev_notify = SIGEV_THREAD;
  starts.sigev_notify_function = [](sigval) { sem_post(&g_expired); };
  timer_create(CLOCK_MONOTONIC, &starts, &timer);
  take("timer_thread", [&] {
    const itimerspec first{{}, duration};
    timer_settime(timer, 0, &first, nullptr);
    sem_wait(&g_expired);
  });
  timer_delete(timer);
}

}  // namespace

int main() {
  sem_init(&g_expired, 0, 0);
  const timespec duration{0, kWait_ns};
  take("nanosleep", [&] { nanosleep(&duration, nullptr); });
  take("usleep", [] { usleep(kWait_ns / 1000); });
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME})
    take("clock_nanosleep", [&] {
      const timespec until = later(clock);
      clock_nanosleep(clock, TIMER_ABSTIME, &until, nullptr);
    });
  take("syscall_sleep", [] {
    const timespec until = later(CLOCK_MONOTONIC);
    syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  });
  take("syscall_clock", [] {
    const timespec until = later(CLOCK_MONOTONIC);
    timespec now{};
    while (now.tv_sec < until.tv_sec || (now.tv_sec == until.tv_sec && now.tv_nsec < until.tv_nsec))
      syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  });
  take("poll", [] { poll(nullptr, 0, 20); });
  take("ppoll", [&] { ppoll(nullptr, 0, &duration, nullptr); });
  take("select", [] {
    timeval time{0, kWait_ns / 1000};
    select(0, nullptr, nullptr, nullptr, &time);
  });
  take("pselect", [&] { pselect(0, nullptr, nullptr, nullptr, &duration, nullptr); });
  const int epoll = epoll_create1(0);
  epoll_event event{};
  take("epoll_wait", [&] { epoll_wait(epoll, &event, 1, 20); });
  take("epoll_pwait2", [&] { epoll_pwait2(epoll, &event, 1, &duration, nullptr); });

  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  pthread_mutex_lock(&mutex);
  take("pthread_cond_timedwait", [&] {
    const timespec until = later(CLOCK_REALTIME);
    pthread_cond_timedwait(&condition, &mutex, &until);
  });
  take("pthread_cond_clockwait", [&] {
    const timespec until = later(CLOCK_MONOTONIC);
    pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &until);
  });
  pthread_mutex_unlock(&mutex);
  sem_t semaphore;
  sem_init(&semaphore, 0, 0);
  take("sem_timedwait", [&] {
    const timespec until = later(CLOCK_REALTIME);
    sem_timedwait(&semaphore, &until);
  });
  take("sem_clockwait", [&] {
    const timespec until = later(CLOCK_MONOTONIC);
    sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until);
  });

  take("thrd_sleep", [&] { thrd_sleep(&duration, nullptr); });
  cnd_t woken;
  mtx_t held;
  cnd_init(&woken);
  mtx_init(&held, mtx_timed);
  mtx_lock(&held);
  take("cnd_timedwait", [&] {
    timespec until{};
    timespec_get(&until, TIME_UTC);
    until.tv_sec += (until.tv_nsec + kWait_ns) / 1'000'000'000;
    until.tv_nsec = (until.tv_nsec + kWait_ns) % 1'000'000'000;
    cnd_timedwait(&woken, &held, &until);
  });

  take("sleep_for", [] { std::this_thread::sleep_for(20ms); });
  std::mutex own;
  std::condition_variable any;
  take("wait_for", [&] {
    std::unique_lock lock(own);
    any.wait_for(lock, 20ms);
  });
  std::promise<int> promise;
  auto future = promise.get_future();
  take("future", [&] { future.wait_for(20ms); });
  std::counting_semaphore<4> counting(0);
  take("counting_semaphore", [&] { static_cast<void>(counting.try_acquire_for(20ms)); });
  const int udp = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(14540);
  bind(udp, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  take("SO_RCVTIMEO", [&] {
    const timeval time{0, kWait_ns / 1000};
    setsockopt(udp, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
    char byte = 0;
    recv(udp, &byte, 1, 0);
  });
  // Timers that are descriptors: once, and at each of four periods of 5 ms.
  std::uint64_t count = 0;
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const auto read_timer = [&] {
    return read(timer, &count, sizeof count) == sizeof count ? count : 0;
  };
  const itimerspec once{{}, duration}, never{};
  take("timerfd_read", [&] {
    timerfd_settime(timer, 0, &once, nullptr);
    read_timer();
  });
  take("timerfd_poll", [&] {
    const itimerspec at{{}, later(CLOCK_MONOTONIC)};
    timerfd_settime(timer, TFD_TIMER_ABSTIME, &at, nullptr);
    pollfd fd{timer, POLLIN, 0};
    poll(&fd, 1, -1);
  });
  event.events = EPOLLIN;
  epoll_ctl(epoll, EPOLL_CTL_ADD, timer, &event);
  const itimerspec period{{0, kWait_ns / 4}, {0, kWait_ns / 4}};
  take("timerfd_epoll_wait", [&] {
    timerfd_settime(timer, 0, &period, nullptr);
    for (std::uint64_t periods = 0; periods < 4; periods += read_timer())
      if (epoll_wait(epoll, &event, 1, 1000) != 1) break;
  });
  take("timerfd_counted_while_nobody_reads", [&] {
    timerfd_settime(timer, 0, &period, nullptr);
    usleep(kWait_ns / 1000 - 100);
    if (read_timer() == 3) read_timer();
  });
  timerfd_settime(timer, 0, &never, nullptr);
  wait_for_signals();
  // One thread computes while another waits; with the CPU time of both.
  const long monotonic = us(CLOCK_MONOTONIC), used = us(CLOCK_PROCESS_CPUTIME_ID);
  std::thread busy([] {
    const long until = us(CLOCK_MONOTONIC) + 40'000;
    while (us(CLOCK_MONOTONIC) < until) {
    }
  });
  std::this_thread::sleep_for(20ms);
  std::printf("woken_beside_computing 0 0\n");
  busy.join();
  std::printf("beside_computing %ld %ld\n", us(CLOCK_MONOTONIC) - monotonic,
              us(CLOCK_PROCESS_CPUTIME_ID) - used);
}
