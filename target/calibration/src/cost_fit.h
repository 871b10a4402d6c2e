#pragma once

#include <array>
#include <string>
#include <vector>

#include <tether/base/count_page.h>

/// The costs of a machine's kinds of work, from times that it took and the work that was counted.
namespace tether::calibration {

/// Of one block of work: what the machine took for it, and how much of each kind it is.
struct CountedBlock {
  std::string name;
  double time_ns = 0.0;  ///< > 0
  std::array<double, kWorkClasses> work{};
  double weight = 1.0;  ///< of its squared error in the fit; > 0
};

using Costs_ns = std::array<double, kWorkClasses>;

double predicted_ns(const Costs_ns& costs, const CountedBlock& block);
/// The prediction's error as a share of the time.
double relative_error(const Costs_ns& costs, const CountedBlock& block);

/// The costs ≥ `floor_ns` with the least weighted sum of squared relative errors. Exact: the
/// least-squares solution of every set of kinds is computed, with the others at their floor, and
/// the best without a cost below its floor is taken.
Costs_ns fit_costs(const std::vector<CountedBlock>& blocks, const Costs_ns& floor_ns);

/// For each block, the relative error of its prediction by a fit to the other blocks.
std::vector<double> errors_when_left_out(const std::vector<CountedBlock>& blocks,
                                         const Costs_ns& floor_ns);

}  // namespace tether::calibration
