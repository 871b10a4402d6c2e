#include "checks/sdf_mend.h"

#include "checks/sdf_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <ignition/math/MassMatrix3.hh>

namespace tether::sim {

namespace {

using ignition::math::MassMatrix3d;
using ignition::math::Vector3d;

/// Children that must not share a name. Models and what is in them are frames as well; the names of
/// links count before those of joints, which nothing else refers to.
const std::array<std::vector<const char*>, 5> kNamespaces = {
    {{"model", "link", "frame", "joint"}, {"light"}, {"visual"}, {"collision"}, {"sensor"}}};

void rename_duplicates(const SdfSource& source, const sdf::ElementPtr& parent,
                       const std::vector<const char*>& kinds, const WarningSink& warn) {
  std::set<std::string> names;
  std::vector<sdf::ElementPtr> duplicates;
  for (const char* kind : kinds) {
    for_each_child(parent, [&](const sdf::ElementPtr& child) {
      if (child->GetName() != kind || name_attribute(child).empty()) return;
      const bool may_rename = source.options().is_tolerant || source.is_included(child);
      if (!names.insert(name_attribute(child)).second && may_rename) duplicates.push_back(child);
    });
  }
  for (const sdf::ElementPtr& duplicate : duplicates) {
    std::string name;
    for (int i = 1; name.empty() || !names.insert(name).second; ++i)
      name = name_attribute(duplicate) + "_" + std::to_string(i);
    warn_at(source, duplicate, Consequence::kNoEffect,
            "has the name of another element; it is now '" + name + "'", warn);
    duplicate->GetAttribute("name")->SetFromString(name);
  }
}

/// Smallest radius of gyration that a mended inertia has.
constexpr double kLeastRadius_m = 1e-3;

template <class... Precision>
std::string digits_of(double number, Precision... precision) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number, precision...).ptr;
  return {text.data(), end};
}
/// The shortest text that reads back as the same number.
std::string exact(double number) {
  return digits_of(number);
}
/// Of nine digits, so that a sum shows why it is too small.
std::string shown(double number) {
  return digits_of(number, std::chars_format::general, 9);
}

std::string three_numbers(const Vector3d& v) {
  return shown(v.X()) + " " + shown(v.Y()) + " " + shown(v.Z());
}

/// In ascending order.
std::array<double, 3> principal_moments(const MassMatrix3d& matrix) {
  const Vector3d principal = matrix.PrincipalMoments();
  std::array<double, 3> m = {principal.X(), principal.Y(), principal.Z()};
  std::ranges::sort(m);
  return m;
}

/// What must be added to each moment, so that the principal ones are positive and none is larger
/// than the sum of the others.
double missing_moment(const MassMatrix3d& matrix) {
  const auto m = principal_moments(matrix);
  const double least = matrix.Mass() * kLeastRadius_m * kLeastRadius_m;
  return std::max({0.0, least - m[0], m[2] - m[0] - m[1]});
}

void mend_inertia(const SdfSource& source, const sdf::ElementPtr& inertial,
                  const WarningSink& warn) {
  const sdf::ElementPtr inertia = inertial->FindElement("inertia");
  if (!inertia) return;
  const auto number = [&](const char* name, double otherwise) {
    return inertia->Get<double>(name, otherwise).first;
  };
  const Vector3d moments{number("ixx", 1.0), number("iyy", 1.0), number("izz", 1.0)};
  const MassMatrix3d matrix(inertial->Get<double>("mass", 1.0).first, moments,
                            {number("ixy", 0.0), number("ixz", 0.0), number("iyz", 0.0)});
  if (matrix.IsValid() && principal_moments(matrix)[0] > 0.0) return;
  if (!source.options().is_tolerant) {
    refuse(source, inertia,
           "has moments that no body can have (ixx, iyy, izz: " + three_numbers(moments) +
               " kg m^2): all must be positive, and none larger than the sum of the other two. "
               "Correct them, or let Tether do it (for UAVs: --tolerant, for worlds: without "
               "--strict)");
  }
  // A little more, because of rounding.
  const double added = missing_moment(matrix) * (1.0 + 1e-6);
  const Vector3d mended = moments + Vector3d(added, added, added);
  warn_at(source, inertia, Consequence::kBehavesDifferent,
          "has moments that no body can have (" + three_numbers(moments) +
              " kg m^2); they are now " + three_numbers(mended),
          warn);
  for (const auto& [name, value] :
       {std::pair("ixx", mended.X()), std::pair("iyy", mended.Y()), std::pair("izz", mended.Z())})
    inertia->GetElement(name)->GetValue()->SetFromString(exact(value));  // Set keeps six digits
}

}  // namespace

void mend(const SdfSource& source, const WarningSink& warn) {
  const std::function<void(const sdf::ElementPtr&)> visit = [&](const sdf::ElementPtr& element) {
    if (element->GetName() == "inertial") mend_inertia(source, element, warn);
    for (const auto& kinds : kNamespaces) rename_duplicates(source, element, kinds, warn);
    for_each_child(element, visit);
  };
  visit(source.element());
}

}  // namespace tether::sim
