#pragma once

#include <string>
#include <vector>

namespace tether {

/// Rows of cells as lines of columns, the first two aligned to the left and the others to the
/// right, without blanks at the end. A row may have fewer cells than others.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// With so many digits after the point, whatever the locale.
std::string fixed(double value, int digits);

}  // namespace tether
