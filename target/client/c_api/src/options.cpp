#include "errors.h"
#include "handles.h"

#include <string>

using tether::c_api::are_given;
using tether::c_api::fail;
using tether::c_api::guarded;

namespace {

/// Runs `change` on what the options will be.
template <class Change>
tether_status set(tether_options* options, const char* text, Change change) {
  if (!are_given(options, text)) return TETHER_INVALID;
  return guarded([&] { return change(std::string(text)); });
}

tether_status set_text(tether_options* options, std::optional<std::string> tether_options::*field,
                       const char* text) {
  return set(options, text, [&](std::string value) {
    options->*field = std::move(value);
    return tether_status{TETHER_OK};
  });
}

}  // namespace

extern "C" {

tether_status tether_options_new(tether_options** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  return guarded([&] {
    *out = new tether_options(false);
    return tether_status{TETHER_OK};
  });
}

tether_status tether_options_from_environment(tether_options** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  return guarded([&] {
    const auto usable = tether::client::options_from_environment();
    if (!usable) return fail(usable.failure());
    *out = new tether_options(true);
    return tether_status{TETHER_OK};
  });
}

void tether_options_free(tether_options* options) noexcept {
  delete options;
}

tether_status tether_options_set_address(tether_options* options, const char* address) noexcept {
  return set(options, address, [&](const std::string& text) {
    const auto parsed = tether::link::parse_address(text);
    if (!parsed) return fail(parsed.failure());
    options->address = *parsed;
    return tether_status{TETHER_OK};
  });
}

tether_status tether_options_set_token(tether_options* options, const char* token) noexcept {
  return set_text(options, &tether_options::token, token);
}
tether_status tether_options_set_uav(tether_options* options, const char* uav) noexcept {
  return set_text(options, &tether_options::uav, uav);
}
tether_status tether_options_set_sut_name(tether_options* options, const char* name) noexcept {
  return set_text(options, &tether_options::sut_name, name);
}

tether_status tether_options_set_clock(tether_options* options, const char* clock) noexcept {
  return set(options, clock, [&](std::string text) {
    const auto source = tether::client::parse_time_source(text);
    if (!source) return fail(TETHER_INVALID, source.failure().message);
    options->clock = std::move(text);
    return tether_status{TETHER_OK};
  });
}

tether_status tether_options_set_timeouts(tether_options* options, int64_t connect_ns,
                                          int64_t welcome_ns) noexcept {
  if (!are_given(options)) return TETHER_INVALID;
  if (connect_ns <= 0 || welcome_ns <= 0)
    return fail(TETHER_INVALID, "a timeout must be greater than 0");
  options->connect_timeout = tether::Duration(connect_ns);
  options->welcome_timeout = tether::Duration(welcome_ns);
  return TETHER_OK;
}

}  // extern "C"
