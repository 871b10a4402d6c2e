#include "scene/trigonometry.h"

namespace tether::raster {
namespace {

// first · (1 − x²/(a(a+1)) · (1 − x²/((a+2)(a+3)) · (…)))
double series(double first, double x2, int a) {
  constexpr int kTerms = 12;
  double sum = 1.0;
  for (int i = a + 2 * (kTerms - 1); i >= a; i -= 2) sum = 1.0 - x2 / (i * (i + 1)) * sum;
  return first * sum;
}

}  // namespace

double sine(double angle_rad) {
  return series(angle_rad, angle_rad * angle_rad, 2);
}

double cosine(double angle_rad) {
  return series(1.0, angle_rad * angle_rad, 1);
}

}  // namespace tether::raster
