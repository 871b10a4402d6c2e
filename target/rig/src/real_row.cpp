#include "distance_reference.h"

#include <cmath>

#include <tether/base/text.h>
#include <tether/base/units.h>
#include <tether/rig/mission.h>
#include <tether/tasks/task.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::rig {
namespace {

using Row = std::vector<std::string>;

/// Pixel coordinates count from the centre of the first column, an editor from its left edge.
vision::Roi roi_of(const PixelBox& box) {
  vision::Roi roi;
  roi.center = {box.left_px + 0.5 * (box.width_px - 1.0), box.top_px + 0.5 * (box.height_px - 1.0)};
  roi.width_px = box.width_px;
  roi.height_px = box.height_px;
  roi.edge_height_px = box.height_px;
  return roi;
}

/// A missing reference is a note; a device that stopped fails the run.
void add_distance_error(const Result<DistanceReference>& reference,
                        const vision::RelativePosition& estimate, RealRow& row) {
  if (!reference) {
    row.outcome = tasks::TaskOutcome::failed(reference.failure());
    return;
  }
  if (!reference->distance_m) {
    row.notes.push_back("no distance reference: " + reference->why_none);
    return;
  }
  row.outcome.results["distance_reference_m"] = *reference->distance_m;
  if (estimate.distance_m) {
    row.outcome.results["distance_error_m"] =
        std::abs(*estimate.distance_m - *reference->distance_m);
  }
}

std::string cell(const RealRow& row, const std::string& result) {
  const auto found = row.outcome.results.find(result);
  return found == row.outcome.results.end() ? "-" : fixed(found->second, 3);
}

}  // namespace

RealRow measure_real_row(const TaskSpec& spec, const std::optional<PixelBox>& true_roi,
                         client::Vehicle& vehicle) {
  tasks::TaskContext context(vehicle, spec.vision);
  tasks::RelativePositionTask task(spec.anchor,
                                   std::get<tasks::RelativePositionOptions>(spec.options));
  RealRow row{tasks::run(task, context), task.sighting(), {}};
  if (row.outcome.failure || !task.estimate()) return row;
  // Both are there, or the task would have failed.
  const uav::SensorDescription& camera = *vehicle.catalogue().find_sensor(spec.vision.camera);
  const uav::Anchor& anchor = *vehicle.catalogue().find_anchor(spec.anchor);
  const vision::RelativePosition& estimate = *task.estimate();
  if (true_roi) {
    const double true_rad = relative_position(camera, anchor, roi_of(*true_roi)).bearing_rad;
    row.outcome.results["angle_error_deg"] =
        deg_from_rad(std::abs(wrap_angle_rad(estimate.bearing_rad - true_rad)));
  }
  add_distance_error(take_distance_reference(vehicle, camera, anchor, estimate.bearing_rad),
                     estimate, row);
  return row;
}

std::string table_2(const RealRow& row, const std::string& location) {
  const std::vector<Row> rows = {{"data origin", "SUT location", "angle error [deg]",
                                  "distance error [m]", "time required [s]"},
                                 {"real sensor", location, cell(row, "angle_error_deg"),
                                  cell(row, "distance_error_m"), cell(row, "duration_s")},
                                 {"paper:"},
                                 {"  real sensor", "target, real-time", "0.285", "0.083", "0.558"}};
  return "Table II: relative position\n" + text_table(rows) +
         "(paper, Table II: means of ten experiments)\n";
}

std::string to_pixel_box(const vision::Roi& roi) {
  const auto edge = [](double center, double size) {
    return std::to_string(std::lround(center - 0.5 * (size - 1.0)));
  };
  return edge(roi.center.u_px, roi.width_px) + "," + edge(roi.center.v_px, roi.height_px) + "," +
         std::to_string(std::lround(roi.width_px)) + "," +
         std::to_string(std::lround(roi.height_px));
}

}  // namespace tether::rig
