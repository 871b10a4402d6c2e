// What hears for a program that is stopped while the simulation catches up: a thread for each
// device, in a call of its own. It goes on with the program when the call's reply is due.

#include "agent.h"
#include "real.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <tether/link/messages.h>

namespace tether::as_is {
namespace {

// A wait looks again after so long [real time].
constexpr Duration kLongestSlice = std::chrono::milliseconds(200);
constexpr Duration kShortestSlice = std::chrono::microseconds(10);
// Execution time is so far ahead of the simulation at most: a message that has not been simulated
// yet cannot stop the program earlier.
constexpr Duration kAhead = std::chrono::milliseconds(5);

// As a driver, which does not wait until the program's threads leave it a core; if that is allowed.
void go_first() {
  sched_param lowest{};
  lowest.sched_priority = ::sched_get_priority_min(SCHED_FIFO);
  constexpr int kLeastNice = -20;
  if (::sched_setscheduler(0, SCHED_FIFO, &lowest) != 0)
    static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLeastNice));
}

}  // namespace

bool Agent::is_first() const {
  const char* const process = std::getenv("TETHER_AS_IS");
  return process != nullptr && std::to_string(process_) == process;
}

/// In real time, if nothing stops the program meanwhile.
Duration Agent::real_until(std::optional<ExecTime> until) const {
  if (!until) return kLongestSlice;
  const double left = static_cast<double>((*until - now()).count()) / factor_;
  return Duration(
      static_cast<std::int64_t>(std::clamp(left, static_cast<double>(kShortestSlice.count()),
                                           static_cast<double>(kLongestSlice.count()))));
}

template <class Hear>
void Agent::hear(std::once_flag& begins, Hear hear) {
  std::call_once(begins, [&] {
    std::thread([hear] {
      const Inside inside;
      ::pthread_setname_np(::pthread_self(), link::kClientThread);
      go_first();
      for (;;) hear();
    }).detach();
  });
}

void Agent::hear_devices() {
  if (port_.is_any())
    hear(hears_controller_, [this] {
      const auto received = vehicle().receive(kAhead);
      if (received && received->from == link::kAutopilot) port_.deliver(received->bytes);
      if (!received && received.failure().kind != Failure::Kind::kNothingYet)
        end(received.failure());
    });
  if (port_.has_receiver())
    hear(hears_receiver_, [this] {
      const auto fix = vehicle().read<uav::NavSatSample>(receiver_);
      if (!fix) end(fix.failure());
      deliver(*fix);
    });
  if (cameras_.is_any())
    for (Camera& camera : cameras_.cameras())
      hear(hears_cameras_.at(camera.sensor()), [this, &camera] { hear_camera(camera); });
}

// A driver that is always there: what finds no buffer is lost.
void Agent::hear_camera(Camera& camera) {
  {
    std::unique_lock leading(leading_);
    streams_change_.wait(leading, [&camera] { return camera.is_streaming(); });
  }
  auto image = vehicle().read<uav::CameraSample>(camera.sensor());
  if (!image) end(image.failure());
  const std::lock_guard leading(leading_);
  arrived_ = std::move(*image);
  camera.take_arrived();
  arrived_.reset();
  const std::string text =
      "has a program whose camera gives JPEG: compressing it is charged, which the camera's own "
      "hardware does on the drone. Fly with YUYV, or with the clock cpu";
  if (camera.is_compressing() && tell(text)) doubt(text);
}

}  // namespace tether::as_is
