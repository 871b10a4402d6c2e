// The C++ API as a C++17 compiler without exceptions sees it, templates included.
#include <tether/client.hpp>

static_assert(__cplusplus == 201703L);
static_assert(std::is_nothrow_move_constructible_v<tether::api::Vehicle>);
static_assert(!std::is_copy_constructible_v<tether::api::Image>);
static_assert(noexcept(tether::api::connect()));

template class tether::api::Result<int>;
template class tether::api::Result<tether::api::Image>;

tether::api::Status look(tether::api::Vehicle& vehicle);

tether::api::Status look(tether::api::Vehicle& vehicle) {
  const auto image = vehicle.read_camera("camera");
  if (!image) return image.failure();
  if (const auto imu = vehicle.read_imu("imu", tether::api::Read::kLatest); !imu)
    return imu.failure();
  const auto images = vehicle.subscribe_camera("camera", [](tether::api::ImageView) {});
  if (!images) return images.failure();
  return vehicle.sleep_for(std::chrono::milliseconds(1));
}
