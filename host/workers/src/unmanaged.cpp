#include <tether/base/error.h>
#include <tether/workers/engine.h>
#include <tether/workers/worker.h>

namespace tether::workers {
namespace {

class Unmanaged final : public Engine {
 public:
  explicit Unmanaged(std::function<Duration()> now) : now_(std::move(now)) {}

  bool start(const Round&, const Order&) override { return false; }

  std::optional<std::vector<Task>> tasks(const Round& round) override {
    std::vector<Task> tasks;
    for (const auto& [id, worker] : read_workers(round)) {
      const auto [seen, is_new] = seen_.try_emplace(id, Seen{worker.beat, now_()});
      if (!is_new && seen->second.beat != worker.beat) seen->second = {worker.beat, now_()};
      const bool is_silent = now_() - seen->second.at >= kSilence;
      tasks.push_back({.name = id,
                       .is_alive = !worker.has_ended && !is_silent,
                       .is_waiting = false,
                       .state = worker.has_ended ? "ended"
                                : is_silent      ? "showed no sign of life"
                                                 : "running",
                       .node = worker.name.node});
    }
    return tasks;
  }

  void cancel(const Round& round) override {
    throw Error(ErrorCode::kUsage, {round.folder().root().string()},
                "its workers were not started by Slurm. End them where you started them.")
        .about("--cancel");
  }

 private:
  struct Seen {
    std::uint64_t beat;
    Duration at;
  };
  std::function<Duration()> now_;
  std::map<std::string, Seen> seen_;
};

}  // namespace

std::unique_ptr<Engine> make_unmanaged(std::function<Duration()> now) {
  return std::make_unique<Unmanaged>(std::move(now));
}

}  // namespace tether::workers
