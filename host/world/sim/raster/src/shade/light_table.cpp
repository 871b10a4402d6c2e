#include "shade/light_table.h"

namespace tether::raster {
namespace {

// x^0.2 by Newton's method, from above.
double fifth_root(double x) {
  constexpr int kSteps = 60;
  double y = 1.0;
  for (int i = 0; i < kSteps; ++i) {
    const double y4 = y * y * y * y;
    y = 0.2 * (4.0 * y + x / y4);
  }
  return y;
}

double linear(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  const double x = (srgb + 0.055) / 1.055;
  return x * x * fifth_root(x * x);  // x^2.4
}

}  // namespace

LightTable::LightTable() : light{}, byte{} {
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = static_cast<float>(kWhite * linear(static_cast<double>(i) / 255.0));
  }
  int nearest = 0;
  double limit = kWhite * linear(0.5 / 255.0);
  for (std::size_t i = 0; i < byte.size(); ++i) {
    while (nearest < 255 && static_cast<double>(i) > limit) {
      ++nearest;
      limit = kWhite * linear((nearest + 0.5) / 255.0);
    }
    byte[i] = static_cast<std::uint8_t>(nearest);
  }
}

const LightTable& light_table() {
  static const LightTable kTable;
  return kTable;
}

}  // namespace tether::raster
