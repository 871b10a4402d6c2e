// Prints of finished runs how much of their wall time is computing that overlaps: for each folder,
// the wall time against the greater of what the program computed and what the simulator did. For
// runs of one UAV on a CPU clock.
#include <algorithm>
#include <cstdio>

#include <tether/base/error.h>
#include <tether/campaign/result.h>
#include <tether/record/reader.h>

namespace {

using namespace tether;

/// Between a reply and the next request. A serial program has one call at a time.
double computed_s(const record::Record& record, double cpu_factor) {
  Duration computed{0};
  ExecTime resumed_at{};
  for (const auto& logged : record.interactions) {
    const record::Interaction& call = logged.message;
    computed += call.request_at - resumed_at;
    resumed_at = call.reply_at;
  }
  return to_seconds(computed) / cpu_factor;
}

void print_row(const std::filesystem::path& folder) {
  const campaign::TrialResult result = campaign::read_result(folder);
  const campaign::SimulatorFigures& simulator = result.this_run.simulator.value();
  const double program_s =
      computed_s(record::read_record(folder / "record.mcap"), result.clock.factor);
  const double simulator_s = to_seconds(simulator.stepping + simulator.drawing);
  const double wall_s = to_seconds(result.this_run.wall);
  std::printf("%-32s %7.2f %8.2f %9.2f %8.2f %7.2f %8llu %6llu %8llu\n",
              (result.scenario + ", " + result.condition).c_str(), wall_s, program_s,
              to_seconds(simulator.stepping), to_seconds(simulator.drawing),
              wall_s / std::max(program_s, simulator_s),
              static_cast<unsigned long long>(simulator.pictures),
              static_cast<unsigned long long>(simulator.drawn_ahead),
              static_cast<unsigned long long>(simulator.drawn_in_vain));
}

}  // namespace

int main(int argc, char** argv) try {
  std::printf("%-32s %7s %8s %9s %8s %7s %8s %6s %8s\n", "seconds of", "wall", "program",
              "stepping", "drawing", "ratio", "pictures", "ahead", "in vain");
  for (int i = 1; i < argc; ++i) print_row(argv[i]);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
