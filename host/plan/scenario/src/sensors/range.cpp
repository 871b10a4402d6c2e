#include "sensors/sensor_key.h"

#include <tether/base/units.h>
#include <tether/sim/bodies.h>

namespace tether::scenario {

std::vector<SensorKey> keys_of(std::type_identity<sim::RangeModel>) {
  using sim::RangeModel;
  constexpr toml::Range kFieldOfView_deg{.min = 0.0, .max = 180.0, .below_max = true};
  return {
      row<RangeModel>("min_m", number(kDistance_m), &RangeModel::min_m),
      row<RangeModel>("max_m", number(kFarthest_m), &RangeModel::max_m),
      row<RangeModel>("resolution_m", number(kDistance_m), &RangeModel::resolution_m),
      row<RangeModel>("field_of_view_deg", number(kFieldOfView_deg, rad_from_deg(1.0)),
                      [](RangeModel& range, double field_of_view_rad) {
                        range.rays_S = sim::cone_of_rays(field_of_view_rad);
                      }),
      row<RangeModel>("dropout_probability", number(kProbability),
                      &RangeModel::dropout_probability),
      row<RangeModel>("noise_m", noise, &RangeModel::noise),
  };
}

void complete(sim::RangeModel& range, const Finished& sensor) {
  sensor.check_limits(range.min_m, range.max_m);
}

}  // namespace tether::scenario
