#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Lines that are overwritten on a terminal. One that is wider than the terminal would wrap, and no
/// longer be overwritten.
namespace tether::os {

/// Moves to the begin of the line and clears it.
inline constexpr const char* kClearLine = "\r\x1b[K";

/// The columns of the terminal behind a descriptor, at this moment; 0 if it is none. 80 if the
/// terminal does not say.
int terminal_columns(int descriptor);

/// The columns for texts of several lines: COLUMNS in the environment if it is a number from 20,
/// else those of the terminal behind the descriptor, else 100.
std::size_t text_columns(int descriptor);

/// Whether a text there may have colours: it is a terminal, and neither NO_COLOR nor TERM=dumb is
/// in the environment (https://no-color.org).
bool shows_colours(int descriptor);

/// The begin of a UTF-8 text that fits in `columns` - 1 columns (in the last one, terminals
/// differ); "…" is the end of what was cut. Wide and combining characters count as they are shown.
std::string cut_to_columns(const std::string& text, int columns);

/// The first fields, as many as fit as a whole, with two blanks between them; of the first field,
/// what fits. Empty fields are left out.
std::string fields_in_columns(const std::vector<std::string>& fields, int columns);

}  // namespace tether::os
