#include "metric_outcome.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>
#include <tether/record/reader.h>

/// The SUT's own estimates against ground truth (paper, Tables II and V): each metric reads the
/// last annotation of a topic, finds the image from which it was made, and compares it with the
/// true pose.
namespace tether::campaign {
namespace {

using Details = nlohmann::json;

// ---- Annotations: written by the SUT, so those that make no sense are skipped.

template <class T>
std::optional<T> value_of(const Details& note, const char* member,
                          bool (Details::*is_type)() const) {
  const auto found = note.find(member);
  if (found == note.end() || !((*found).*is_type)()) return std::nullopt;
  return found->get<T>();
}

std::optional<double> number_of(const Details& note, const char* member) {
  return value_of<double>(note, member, &Details::is_number);
}

std::optional<std::string> string_of(const Details& note, const char* member) {
  return value_of<std::string>(note, member, &Details::is_string);
}

// The last annotation before the SUT finished for which `read` returns something.
template <class Note>
std::optional<Note> last_note(const record::Record& record, const std::string& uav,
                              const std::string& topic,
                              std::optional<Note> (*read)(const Details&, const scenario::Metric&),
                              const scenario::Metric& metric) {
  const auto* finish = find_finish(record, uav);
  const auto& notes = record.annotations;
  for (auto logged = notes.rbegin(); logged != notes.rend(); ++logged) {
    const record::Annotation& message = logged->message;
    if (message.uav != uav || message.topic != topic || logged->order > finish->order) continue;
    const Details note = Details::parse(message.json, nullptr, false);
    if (!note.is_object()) continue;
    if (const std::optional<Note> read_note = read(note, metric)) return read_note;
  }
  return std::nullopt;
}

struct Estimate {
  std::string camera;
  std::uint64_t image_index = 0;
  double bearing_rad = 0.0;
  std::optional<double> distance_m;
};

// Of the metric's anchor.
std::optional<Estimate> read_estimate(const Details& note, const scenario::Metric& metric) {
  const auto camera = string_of(note, "camera");
  const auto bearing_rad = number_of(note, "bearing_rad");
  const auto index = value_of<std::uint64_t>(note, "image_index", &Details::is_number_unsigned);
  const bool is_of_anchor = string_of(note, "anchor") == metric.anchor;
  if (!is_of_anchor || !camera || !bearing_rad || !index) return std::nullopt;
  return Estimate{*camera, *index, *bearing_rad, number_of(note, "distance_m")};
}

std::optional<uav::Vec3> read_displacement(const Details& note, const scenario::Metric&) {
  const auto x_m = number_of(note, "x_m"), y_m = number_of(note, "y_m");
  if (!x_m || !y_m) return std::nullopt;
  return uav::Vec3{*x_m, *y_m, 0.0};
}

// ---- The image from which an estimate was made.

const record::SensorInfo* find_camera(const record::Record& record, const std::string& uav,
                                      const std::string& name) {
  for (const record::SensorInfo& sensor : record.header.sensors) {
    if (sensor.uav == uav && sensor.name == name && sensor.camera) return &sensor;
  }
  return nullptr;
}

// The SUT's last estimate, with the ground truth of its image.
struct Look {
  Estimate estimate;
  record::SensorInfo camera;  // as it was mounted
  record::Anchor anchor;      // when the image was taken
  const record::Interaction* read = nullptr;
  uav::Pose X_WB;
};

MetricOutcome with_last_look(const scenario::Metric& metric, const record::Record& record,
                             MetricOutcome (*evaluate)(const Look&)) {
  const record::Anchor* anchor = find_anchor(record, metric.anchor);
  if (anchor == nullptr) return no_anchor(metric);
  if (find_finish(record, metric.uav) == nullptr) return no_finish(metric);
  const auto estimate = last_note(record, metric.uav, "estimate", read_estimate, metric);
  if (!estimate) {
    return missing(
        fmt::format("the SUT of '{}' left no estimate of '{}'", metric.uav, metric.anchor));
  }
  const record::SensorInfo* camera = find_camera(record, metric.uav, estimate->camera);
  if (camera == nullptr) {
    return missing(fmt::format("the record does not describe a camera '{}' of '{}'",
                               estimate->camera, metric.uav));
  }
  const record::Interaction* read =
      find_read(record, metric.uav, estimate->camera, estimate->image_index);
  if (read == nullptr) {
    return missing(
        fmt::format("the SUT of '{}' estimated from image {} of '{}', which it never "
                    "received",
                    metric.uav, estimate->image_index, estimate->camera));
  }
  const SimTime taken_at = read->sample_state_at.value_or(*read->sampled_at);
  const auto X_WB = pose_at(record, metric.uav, taken_at);
  if (!X_WB) return no_ground_truth(metric);
  return evaluate({*estimate, mounted_at(*camera, record, taken_at),
                   record::AnchorTrack(*anchor, record).at(taken_at), read, *X_WB});
}

MetricOutcome bearing_error_of(const Look& look) {
  const auto roi = roi_in_image(*look.read, look.camera, look.X_WB, look.anchor);
  if (!roi) {
    return missing(fmt::format(
        "'{}' {} the camera '{}' in the image of the estimate", look.anchor.name,
        look.read->seen_anchors ? "is hidden from" : "is not in front of", look.camera.name));
  }
  const double true_rad = roi_bearing_rad(look.camera, *roi);
  return {deg_from_rad(std::abs(wrap_angle_rad(look.estimate.bearing_rad - true_rad))), ""};
}

MetricOutcome distance_error_of(const Look& look) {
  if (!look.estimate.distance_m) {
    return missing(
        fmt::format("the SUT's last estimate of '{}' has no distance", look.anchor.name));
  }
  const uav::Vec3 p_WC = camera_pose(look.camera, look.X_WB).p;
  const double true_m = std::hypot(look.anchor.p_WA_m[0] - p_WC.x, look.anchor.p_WA_m[1] - p_WC.y);
  return {std::abs(*look.estimate.distance_m - true_m), ""};
}

}  // namespace

MetricOutcome bearing_error(const scenario::Metric& metric, const record::Record& record) {
  return with_last_look(metric, record, bearing_error_of);
}

MetricOutcome distance_error(const scenario::Metric& metric, const record::Record& record) {
  return with_last_look(metric, record, distance_error_of);
}

// Both in the start-heading frame H0: ahead at the start, and to the left.
MetricOutcome estimate_error(const scenario::Metric& metric, const record::Record& record) {
  if (find_finish(record, metric.uav) == nullptr) return no_finish(metric);
  const auto said_H0 = last_note(record, metric.uav, "displacement", read_displacement, metric);
  if (!said_H0) {
    return missing(fmt::format("the SUT of '{}' left no estimate of its displacement", metric.uav));
  }
  const auto path = start_and_end(record, metric.uav);
  if (!path) return no_ground_truth(metric);
  const uav::Quat q_H0W = uav::from_rpy(0.0, 0.0, -uav::yaw_rad(path->start.q));
  const uav::Vec3 off_H0 = *said_H0 - rotate(q_H0W, path->end.p - path->start.p);
  return {std::hypot(off_H0.x, off_H0.y), ""};
}

}  // namespace tether::campaign
