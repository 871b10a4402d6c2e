#pragma once

#include "files/sdf_source.h"

#include <tether/base/error.h>

namespace tether::sim {

/// What a file is read for: sensors belong to UAVs, lights and physics to worlds.
enum class SdfPurpose { kWorld, kUav };

/// What a simulation that goes without something differs in.
struct Effect {
  // Implicit: most warnings change what their consequence usually changes.
  constexpr Effect(Consequence what)  // NOLINT(google-explicit-constructor)
      : Effect(what, usually_changes_verdict(what)) {}
  constexpr Effect(Consequence what, bool changes_verdict)
      : consequence(what), can_change_verdict(changes_verdict) {}

  Consequence consequence;
  bool can_change_verdict;
};

/// The effect of leaving out an element that Tether does not represent. One that says what holds
/// without it, or is about the motion of a static model, changes no verdict.
Effect effect_without(const sdf::ElementPtr& element, SdfPurpose purpose);

/// Whether an element that Tether does not represent says what holds without it, so that nobody
/// needs to know that it was left out.
bool says_nothing(const sdf::ElementPtr& element);

/// Whether an element is in a model that is static or is nested in one that is.
bool is_in_static_model(const sdf::ElementPtr& element);

}  // namespace tether::sim
