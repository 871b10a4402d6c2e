#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

// Simulated experiments of `tether size` with known curves: how often the interval covers the
// truth, and how many flights it takes, beside a fixed grid of slowdowns with the same statistics.
// The truth is what the answer is about: the slowdown up to which the share of success in each
// neighbourhood is the wanted one. Prints the table of docs/adr/0057:
//   sizing_bench [EXPERIMENTS PER KIND] [KIND]
namespace {

using namespace tether;
using sizing::Flight;

constexpr std::size_t kMostFlights = 300;       // as tether size by default
constexpr std::size_t kMostGridFlights = 3000;  // of the fixed grid
constexpr double kSuccess = 0.9;

/// The outcome of a flight at a slowdown.
using Fly = std::function<Flight(double slowdown, KeyedRandom& random)>;
/// The share of flights that succeed at a slowdown.
using Share = std::function<double(double slowdown)>;

struct Known {
  Share share;
  Fly fly;
};

double between(double low, double high, KeyedRandom& random) {
  return low + (high - low) * random.uniform();
}

double logit(double share) {
  return std::log(share / (1.0 - share));
}

Known with_share(const Share& share) {
  return {share, [=](double slowdown, KeyedRandom& random) {
            return Flight{slowdown, random.uniform() < share(slowdown)};
          }};
}

/// A logistic curve through kSuccess at the threshold.
Known logistic(double threshold, double width, double lapses) {
  const double offset = logit(kSuccess / (1.0 - lapses));
  return with_share([=](double slowdown) {
    return (1.0 - lapses) / (1.0 + std::exp(-std::log(threshold / slowdown) / width - offset));
  });
}

struct Noise {
  std::function<double(KeyedRandom&)> draw;
  std::function<double(double)> share_below;
  double quantile = 0.0;  // a share of kSuccess is below
};

/// A margin that falls with the log slowdown, with symmetric noise. Far beyond the limit there is
/// no value.
Known with_margin(double threshold, double width, double scale, const Noise& noise) {
  constexpr double kLargest = 0.6;
  const auto mean = [=](double slowdown) {
    return std::log(threshold / slowdown) / width + noise.quantile;
  };
  return {[=](double slowdown) { return noise.share_below(mean(slowdown)); },
          [=](double slowdown, KeyedRandom& random) {
            const double margin =
                std::min(scale * width * (mean(slowdown) + noise.draw(random)), kLargest);
            if (margin < -0.8) return Flight{slowdown, false};
            return Flight{slowdown, margin >= 0.0, margin};
          }};
}

/// The slowdown up to which the share in each neighbourhood is at least kSuccess.
double threshold_of(const Share& share, const sizing::Question& question) {
  constexpr double kStep = 0.0005;  // log slowdown
  const auto reach =
      static_cast<std::size_t>(std::round(std::log(sizing::neighbourhood_reach(question)) / kStep));
  std::vector<double> sums = {0.0};
  for (std::size_t i = 0;; ++i) {
    sums.push_back(sums.back() + share(question.least * std::exp(kStep * static_cast<double>(i))));
    if (i < 2 * reach) continue;
    const double mean = (sums[i + 1] - sums[i - 2 * reach]) / static_cast<double>(2 * reach + 1);
    if (mean < kSuccess)
      return question.least * std::exp(kStep * (static_cast<double>(i - reach) - 0.5));
  }
}

struct Kind {
  const char* name;
  const char* description;
  bool has_margins;
  std::function<Known(double threshold, KeyedRandom&)> make;
};

const std::vector<Kind>& kinds() {
  static const Noise logistic_noise = {
      [](KeyedRandom& random) { return logit(std::clamp(random.uniform(), 1e-12, 1.0 - 1e-12)); },
      [](double z) { return 1.0 / (1.0 + std::exp(-z)); }, logit(kSuccess)};
  constexpr double kDeviation = 1.6;
  static const Noise normal_noise = {
      [](KeyedRandom& random) { return kDeviation * random.normal(); },
      [](double z) { return 0.5 * std::erfc(-z / kDeviation / std::sqrt(2.0)); },
      1.2815515655 * kDeviation};
  static const std::vector<Kind> all = {
      {"steep", "from 90 to 10 % over a factor of 1.25 to 1.6", false,
       [](double t, KeyedRandom& r) { return logistic(t, between(0.05, 0.1, r), 0.0); }},
      {"medium", "over a factor of 1.6 to 2.4", false,
       [](double t, KeyedRandom& r) { return logistic(t, between(0.1, 0.2, r), 0.0); }},
      {"flat", "over a factor of 2.4 to 4.7", false,
       [](double t, KeyedRandom& r) { return logistic(t, between(0.2, 0.35, r), 0.0); }},
      {"lapses", "medium; 2 to 5 % of all flights fail", false,
       [](double t, KeyedRandom& r) {
         return logistic(t, between(0.1, 0.2, r), between(0.02, 0.05, r));
       }},
      {"step", "98 % up to the threshold, 30 % beyond", false,
       [](double t, KeyedRandom&) {
         return with_share([=](double x) { return x <= t ? 0.98 : 0.3; });
       }},
      {"steps", "99 %, 94 %, threshold, 60 %, 10 %", false,
       [](double t, KeyedRandom&) {
         return with_share([=](double x) {
           return x <= 0.7 * t ? 0.99 : x <= t ? 0.94 : x <= 1.5 * t ? 0.6 : 0.1;
         });
       }},
      {"gap", "98 %, threshold, 30 % up to 1.5 × as slow, then 95 % up to 2.5 ×", false,
       [](double t, KeyedRandom&) {
         return with_share([=](double x) {
           return x <= t ? 0.98 : x <= 1.5 * t ? 0.3 : x <= 2.5 * t ? 0.95 : 0.05;
         });
       }},
      {"margin", "medium, with a margin of logistic noise", true,
       [](double t, KeyedRandom& r) {
         return with_margin(t, between(0.1, 0.2, r), between(0.5, 1.5, r), logistic_noise);
       }},
      {"normal margin", "medium, with a margin of normal noise", true,
       [](double t, KeyedRandom& r) {
         return with_margin(t, between(0.1, 0.2, r), between(0.5, 1.5, r), normal_noise);
       }},
  };
  return all;
}

struct Run {
  std::size_t flights = 0;
  sizing::Answer answer{};
};

Run run_adaptive(const sizing::CurveGrid& grid, const Kind& kind, const Fly& fly,
                 KeyedRandom& random) {
  sizing::Sizing sizing(grid, kind.has_margins);
  for (;;) {
    const bool is_last = sizing.flights().size() >= kMostFlights;
    const sizing::Answer answer = sizing.answer(is_last);
    if (answer.is_narrow || is_last) return {sizing.flights().size(), answer};
    for (const double slowdown : sizing.next(2)) sizing.add(fly(slowdown, random));
  }
}

/// Ten slowdowns, each flown as often as the others, until the same curve is as narrow.
std::size_t run_grid(const sizing::CurveGrid& grid, const Fly& fly, KeyedRandom& random) {
  using sizing::SuccessCurve;
  SuccessCurve curve(grid, SuccessCurve::Margins::kIgnored);
  const sizing::Question& question = grid.question();
  std::size_t flights = 0;
  while (flights < kMostGridFlights) {
    for (int i = 0; i < 10; ++i, ++flights)
      curve.observe(
          fly(question.least * std::pow(question.most / question.least, i / 9.0), random));
    const sizing::Threshold threshold = curve.threshold();
    if (threshold.high <= question.interval * threshold.low) break;
  }
  return flights;
}

std::size_t median(std::vector<std::size_t> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

void bench(const sizing::CurveGrid& grid, const Kind& kind, std::uint64_t count) {
  std::uint64_t covered = 0, optimistic = 0, narrow = 0, by_levels = 0, covered_exactly = 0;
  std::vector<std::size_t> flights, grid_flights;
  for (std::uint64_t i = 0; i < count; ++i) {
    KeyedRandom random({i, random_stream(kind.name, "", "experiment"), 0});
    const double threshold = std::exp(between(std::log(2.0), std::log(20.0), random));
    const auto [share, fly] = kind.make(threshold, random);
    const auto [used, answer] = run_adaptive(grid, kind, fly, random);
    flights.push_back(used);
    constexpr double kRounding = 1.0001;
    const auto is_covered = [&](double truth) {
      return truth * kRounding >= answer.threshold.low &&
             truth <= answer.threshold.high * kRounding;
    };
    const double truth = threshold_of(share, grid.question());
    covered += is_covered(truth);
    optimistic += truth * kRounding < answer.threshold.low;
    covered_exactly += is_covered(threshold);
    narrow += answer.is_narrow;
    by_levels += answer.basis == sizing::Basis::kLevels;
    if (i % 10 == 0) grid_flights.push_back(run_grid(grid, fly, random));
  }
  const auto percent = [&](std::uint64_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(count);
  };
  fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.1f} % | {} | {:.0f} % | {:.0f} % | {}{} |\n",
             kind.name, kind.description, percent(covered), percent(optimistic),
             percent(covered_exactly), median(flights), percent(narrow), percent(by_levels),
             median(grid_flights) >= kMostGridFlights ? "more than " : "", median(grid_flights));
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const sizing::CurveGrid grid({.success = kSuccess});
  const std::uint64_t experiments = count > 1 ? std::strtoull(words[1], nullptr, 10) : 1112;
  fmt::print(
      "| curve | success | interval covers the threshold | threshold is below it | covers that of "
      "single slowdowns | flights (median) | narrow enough by {} | answered by levels | flights of "
      "a fixed grid (median) |\n"
      "|:---|:---|---:|---:|---:|---:|---:|---:|---:|\n",
      kMostFlights);
  for (const Kind& kind : kinds())
    if (count < 3 || kind.name == std::string(words[2])) bench(grid, kind, experiments);
}
