// Worker is the loop: claim a chunk, fly its items on this machine's own disk, copy each result
// into the shared folder and rename it there. OwnState is its file in the round, and Heart a thread
// that keeps that file fresh where nobody else knows whether the worker is alive.

#include "notes.h"

#include <mutex>
#include <thread>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/interrupt.h>
#include <tether/workers/worker.h>

namespace tether::workers {
namespace {

namespace fs = std::filesystem;

constexpr auto kBeatPeriod = std::chrono::seconds(20);

/// The worker's file in the round, which other threads of it may write.
class OwnState {
 public:
  OwnState(const Round& round, const WorkerName& self) : round_(round) {
    state_.name = self;
    round_.folder().create(file(), text_of(state_));
  }
  template <class Change>
  void change(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(state_);
    ++state_.beat;
    round_.folder().replace(file(), text_of(state_), "part");
  }

 private:
  fs::path file() const { return round_.path("workers/" + state_.name.id); }

  const Round& round_;
  std::mutex mutex_;
  WorkerState state_;
};

/// Changes the worker's file every now and then, where no engine knows whether it is alive.
class Heart {
 public:
  explicit Heart(OwnState& state)
      : thread_([&state](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            os::sleep_unless_stopped(kBeatPeriod, stop);
            try {
              if (!stop.stop_requested()) state.change([](WorkerState&) {});
            } catch (const Error&) {
              continue;  // the next trial finds it, if it lasts
            }
          }
        }) {}

 private:
  std::jthread thread_;
};

class Worker {
 public:
  Worker(const Round& round, const WorkerSetup& setup)
      : round_(round), setup_(setup), state_(round, setup.self), claims_(round, setup.self) {}

  WorkerEnd run() {
    try {
      scale_ = node_scale(round_, setup_);
    } catch (const Error& error) {
      end(error.what(), error.code() == ErrorCode::kUsage);
      throw;
    }
    std::optional<Heart> heart;
    if (round_.settings().beats) heart.emplace(state_);
    try {
      while (!setup_.stop.stop_requested()) {
        const auto chunk = claims_.next();
        if (!chunk || !fly(*chunk)) break;
      }
    } catch (const Error& error) {
      heart.reset();
      end(error.what(), false);
      throw;
    }
    heart.reset();
    if (setup_.stop.stop_requested() && end_.why_early.empty()) end_.why_early = "was stopped";
    end(end_.why_early, false);
    return end_;
  }

 private:
  void end(const std::string& why, bool is_refused) {
    try {
      state_.change([&](WorkerState& state) {
        state.has_ended = true;
        state.is_refused = is_refused;
        state.why_early = why;
      });
    } catch (const Error&) {
      // Then it has vanished, as a worker does that was killed.
    }
  }

  // False: this worker flies no more.
  bool fly(const Chunk& chunk) {
    if (chunk.shard != shard_) items_ = round_.items(chunk.shard);
    shard_ = chunk.shard;
    const std::size_t first_of_shard = round_.first_item({chunk.shard, 0});
    for (std::size_t i = round_.first_item(chunk); i < round_.end_item(chunk); ++i) {
      if (setup_.stop.stop_requested()) return false;
      if (!fly(i, items_.at(i - first_of_shard))) return false;
    }
    return true;
  }

  bool fly(std::size_t index, const Item& item) {
    const fs::path local = setup_.scratch / std::to_string(index);
    fs::create_directories(local);
    const auto lose = [&](const std::string& why) {
      ++end_.lost;
      round_.folder().create(round_.path(fmt::format("lost/{}", index)), text_of(setup_.self, why));
    };
    Flight flight;
    try {
      flight = setup_.fly(item, local, scale_);
      if (flight.end == Flight::End::kResult) {
        setup_.check();
        hand_in(index, item, local);
      }
    } catch (const Error& error) {
      try {
        lose(error.what());
      } catch (const Error&) {
        // The folder is full or gone. The first item of a chunk without a result is lost anyway.
      }
      throw;
    }
    fs::remove_all(local);
    if (flight.end == Flight::End::kResult) {
      losses_in_a_row_ = 0;
      return true;
    }
    lose(flight.why);
    if (flight.end == Flight::End::kStopped) {
      end_.why_early = flight.why;
      return false;
    }
    if (++losses_in_a_row_ < kMostLossesInARow) return true;
    end_.why_early = fmt::format("{} trials in a row were lost: {}", losses_in_a_row_, flight.why);
    return false;
  }

  // If another worker was faster, for instance one that was thought dead, its result stays.
  void hand_in(std::size_t index, const Item& item, const fs::path& local) {
    const fs::path staging =
        fs::path(kWorkersFolder) / "staging" / setup_.self.id / std::to_string(index);
    if (round_.folder().publish(local, staging, item.folder)) ++end_.flown;
  }

  const Round& round_;
  const WorkerSetup& setup_;
  OwnState state_;
  Claims claims_;
  double scale_ = 1.0;
  std::optional<std::size_t> shard_;
  std::vector<Item> items_;
  std::size_t losses_in_a_row_ = 0;
  WorkerEnd end_;
};

}  // namespace

WorkerEnd work(const Round& round, const WorkerSetup& setup) {
  return Worker(round, setup).run();
}

}  // namespace tether::workers
