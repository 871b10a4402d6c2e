#include <tether/client_testing/manual_time_source.h>

namespace tether::client_testing {

ManualTimeSource::ManualTimeSource(computer::ClockKind kind, double factor)
    : clock_{kind, factor},
      elapsed_ns_(std::make_shared<std::atomic<std::int64_t>>(0)),
      children_ns_(std::make_shared<std::atomic<std::int64_t>>(0)) {}

}  // namespace tether::client_testing
