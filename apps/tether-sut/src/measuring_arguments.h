#pragma once

#include "calibrate.h"
#include "characterize.h"
#include "real_row.h"

#include <string>

#include <tether/base/result.h>

namespace CLI {
class App;
}

/// Options of what this program measures besides flying tasks.
namespace tether::sut {

/// Of `characterize`.
void add_characterize_options(CLI::App& app, CharacterizeOptions& options);
/// What holds for several options together: kInvalid, one line.
Status check(const CharacterizeOptions& options);

/// Of `calibrate`.
void add_calibrate_options(CLI::App& app, CalibrateOptions& options);

/// Of `relative_position` with real devices.
void add_real_row_options(CLI::App& app, RealRowOptions& options);
/// Whether one of these was given.
bool is_given(const RealRowOptions& options);

}  // namespace tether::sut
