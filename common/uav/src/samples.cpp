#include <tether/uav/samples.h>

namespace tether::uav {

SimTime sampled_at(const Sample& sample) {
  return std::visit([](const auto& s) { return s.sampled_at; }, sample);
}

}  // namespace tether::uav
