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

/// What was set; the rest is what the environment says when connecting, or the default. Kept as
/// words and numbers, so that one can connect with them more than once.
struct tether_options {
  explicit tether_options(bool by_environment) noexcept : of_environment(by_environment) {}

  bool of_environment;
  std::optional<tether::link::Address> address;
  std::optional<std::string> token;
  std::optional<std::string> uav;
  std::optional<std::string> sut_name;
  std::optional<std::string> clock;
  std::optional<tether::Duration> connect_timeout;
  std::optional<tether::Duration> welcome_timeout;
};

struct tether_message {
  tether::client::RadioMessage message;
};

/// Pixels of its own, or those that a subscription shows for as long as its callback runs.
struct tether_image {
  explicit tether_image(tether::uav::CameraSample&& kept) : own(std::move(kept)), sample(&own) {}
  explicit tether_image(const tether::uav::CameraSample* shown) : sample(shown) {}
  tether_image(const tether_image&) = delete;
  tether_image& operator=(const tether_image&) = delete;

  tether::uav::CameraSample own;
  const tether::uav::CameraSample* sample;
};
