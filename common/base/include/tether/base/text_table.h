#pragma once

#include <string>
#include <vector>

namespace tether {

/// Rows of cells as lines of columns, the first two aligned to the left and the others to the
/// right, without blanks at the end. A row may have fewer cells than others.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// The number with `digits` digits after the point, in any locale.
std::string fixed(double value, int digits);

/// The number with `digits` significant digits, or with as many more as it needs to differ from
/// another number, such as its limit.
std::string distinct_text(double value, double other, int digits);

}  // namespace tether
