#pragma once

#include <vector>

namespace tether::system_test {

/// Two-sample Kolmogorov-Smirnov test: how likely two samples of one distribution differ at least
/// as much as these do (asymptotic, with Stephens' correction for small samples; Press et al.,
/// "Numerical Recipes", section 14.3.3). Ties make it larger than it is. @pre neither is empty.
double kolmogorov_smirnov_p(std::vector<double> a, std::vector<double> b);

}  // namespace tether::system_test
