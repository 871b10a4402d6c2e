#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <tether/client.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/client/vehicle.h>

/// What stands behind the opaque types of <tether/client.h>.

struct tether_vehicle {
  explicit tether_vehicle(std::unique_ptr<tether::client::Vehicle> flown)
      : vehicle(std::move(flown)) {}
  std::unique_ptr<tether::client::Vehicle> vehicle;
};

/// Kept as the words that were given, so that one can connect with them more than once.
struct tether_options {
  std::optional<tether::link::Address> address;
  std::string token;
  std::string uav;
  std::string sut_name;
  std::string clock = "wall";
  tether::Duration connect_timeout = std::chrono::seconds(10);
  tether::Duration welcome_timeout = std::chrono::seconds(60);
};

struct tether_image {
  tether::uav::CameraSample sample;
};
