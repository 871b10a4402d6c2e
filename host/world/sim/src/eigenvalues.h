#pragma once

#include <complex>
#include <vector>

namespace tether::sim {

/// Rows of a square matrix.
using Matrix = std::vector<std::vector<std::complex<double>>>;

/// The eigenvalues of a matrix, in no order, by QR steps with
/// Wilkinson's shift (Golub and Van Loan, "Matrix Computations", section 7.5). Those that are not
/// found, of a matrix with non-finite numbers, are infinite.
std::vector<std::complex<double>> eigenvalues(Matrix a);

}  // namespace tether::sim
