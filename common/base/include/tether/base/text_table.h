#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tether {

/// Of texts that do not depend on the width of a terminal.
inline constexpr std::size_t kAnyColumns = std::numeric_limits<std::size_t>::max();

/// The columns that a UTF-8 text of one line takes, without those of escape sequences for colours.
std::size_t columns_of(const std::string& text);

/// Rows of cells as lines of columns, the first two aligned to the left and the others to the
/// right, without blanks at the end. A row may have fewer cells than others. If a line would be
/// longer than `columns`, `text_lists` of the rows below the first one, which has the headings.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       std::size_t columns = kAnyColumns);

/// A block of lines for each row: its first cell, then a line with the heading and the text of each
/// other cell that is not empty. Not longer than `columns`, if the words are not.
std::string text_lists(const std::vector<std::string>& headings,
                       const std::vector<std::vector<std::string>>& rows, std::size_t columns);

/// Breaks lines that are longer than `columns` between words. The rest of a line begins below its
/// text: what follows its mark ("→ ", "- ") or its label, which two blanks or more end. Longer
/// words stay whole.
std::string wrapped(const std::string& text, std::size_t columns);

/// The number with `digits` digits after the point, in any locale.
std::string fixed(double value, int digits);

/// The number with `digits` significant digits, or with as many more as it needs to differ from
/// another number, such as its limit.
std::string distinct_text(double value, double other, int digits);

}  // namespace tether
