#include "machine_watch.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <tether/board/target_probe.h>
#include <tether/os/machine.h>
#include <tether/os/process_table.h>

namespace tether::runner {

namespace {

// The median of so many tells what is usual, whatever interrupts a few.
constexpr std::size_t kBlocks = 15;
// As well as the factor of a target is known.
constexpr double kUneven = 0.1;
// What a desktop or the services of a server take is less.
constexpr double kBusy = 0.1;
/// From this share of others on, programs of much memory lose what they have in the caches at each
/// turn of others, which the blocks do not feel: image processing with NumPy took up to 80 % longer
/// while others took 92 %, and some 10 % longer at 67 %.
constexpr double kCrowdedCaches = 0.5;

constexpr const char* kHost = "host";
constexpr std::size_t kWords = 1u << 16;

/// About 1 ms of integer and floating-point arithmetic on 512 KiB, which a neighbour's work can
/// displace from the second cache.
void compute_block(std::vector<std::uint64_t>& words) {
  std::uint64_t state = 1;
  double sum = 0.0;
  for (std::size_t i = 0; i < 6 * kWords; ++i) {
    state = state * 6'364'136'223'846'793'005u + 1'442'695'040'888'963'407u;
    std::uint64_t& word = words[(state >> 33) % kWords];
    word = (word ^ state) + i;
    sum = sum * 0.5 + static_cast<double>(word >> 12);
  }
  words[0] += static_cast<std::uint64_t>(sum) & 1u;
}

constexpr std::size_t kEnoughBlocks = 5;  // of a run, for a median
// Two blocks so often take 1 % of a core.
constexpr Duration kBetweenBlocks = std::chrono::milliseconds(200);

std::vector<Duration> times_of_blocks(const MachineReader& reader) {
  reader.time_block();  // the first one fills the caches
  std::vector<Duration> times(kBlocks);
  for (Duration& time : times) time = reader.time_block();
  std::ranges::sort(times);
  return times;
}

Duration median(const std::vector<Duration>& sorted) {
  return sorted[sorted.size() / 2];
}

}  // namespace

MachineReader machine_reader(clockid_t clock) {
  return {.time_block =
              [clock, words = std::vector<std::uint64_t>(kWords)]() mutable {
                const Duration begin = os::read_clock(clock);
                compute_block(words);
                return os::read_clock(clock) - begin;
              },
          .processors = os::processor_time,
          .own = os::used_with_descendants};
}

MachineWatch::MachineWatch(MachineReader reader)
    : reader_(std::move(reader)),
      before_(times_of_blocks(reader_)),
      processors_(reader_.processors()),
      own_(reader_.own()) {}

void MachineWatch::during_run(WallTime now) {
  if (now - last_ < kBetweenBlocks) return;
  last_ = now;
  reader_.time_block();
  during_.push_back(reader_.time_block());
}

void MachineWatch::end_of_run() {
  const auto now = reader_.processors();
  const Duration own = reader_.own() - own_;
  if (!now || !processors_) return;
  const Duration taken = (now->used - processors_->used) + (now->stolen - processors_->stolen);
  const Duration all = taken + (now->idle - processors_->idle);
  if (all > Duration(0)) others_ = std::max(0.0, to_seconds(taken - own) / to_seconds(all));
}

campaign::MachineLoad MachineWatch::load(bool knows_programs) {
  const std::vector<Duration> after = times_of_blocks(reader_);
  std::ranges::sort(during_);
  // Of a short run, little more is known than what was before and after it.
  const bool knows_run = during_.size() >= kEnoughBlocks;
  const Duration usual = knows_run ? median(during_) : std::max(median(before_), median(after));
  Duration shortest = std::min(before_.front(), after.front());
  if (knows_run) shortest = std::min(shortest, during_.front());
  return {.machine = kHost,
          .block_spread = to_seconds(usual) / to_seconds(std::max(shortest, Duration(1))) - 1.0,
          .others = knows_programs ? others_ : 0.0};
}

campaign::TargetReport report_of(const record::TargetInfo& info, const record::Readings& after,
                                 std::string& reason) {
  campaign::TargetReport target{
      .name = info.name, .address = info.address, .before = info.before, .after = after};
  const bool is_board = !info.address.empty();
  for (const board::RunWarning& warning :
       board::run_warnings(target.before, target.after, is_board)) {
    target.warnings.push_back(warning.text);
    if (!warning.spoils || !is_board) continue;
    target.is_spoiled = true;
    reason += "; but " + warning.text;
  }
  return target;
}

std::optional<campaign::MachineLoad> load_of_board(const campaign::TargetReport& target) {
  const auto share = board::contended_share(target.before, target.after);
  if (target.address.empty() || !share) return std::nullopt;
  return campaign::MachineLoad{.machine = target.name, .block_spread = 0.0, .others = *share};
}

std::optional<campaign::Doubt> doubt_of(const campaign::MachineLoad& load, bool counts_turns) {
  const double others = counts_turns                    ? load.others
                        : load.others >= kCrowdedCaches ? load.others * load.others
                                                        : 0.0;
  if (load.block_spread <= kUneven && others <= kBusy) return std::nullopt;
  return campaign::Doubt{campaign::Doubt::Kind::kBusyMachine,
                         load.machine == kHost ? "" : load.machine,
                         std::max(load.block_spread, others)};
}

}  // namespace tether::runner
