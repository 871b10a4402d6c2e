#pragma once

#include <array>
#include <string_view>

/// The keys of a scenario and of its tables.
namespace tether::scenario {

inline constexpr std::array<std::string_view, 20> kScenarioKeys = {"name",
                                                                   "description",
                                                                   "world",
                                                                   "step_ms",
                                                                   "time_limit_s",
                                                                   "hang_limit_s",
                                                                   "connect_limit_s",
                                                                   "max_contact_speed_m_s",
                                                                   "anchors",
                                                                   "target",
                                                                   "uav",
                                                                   "sut",
                                                                   "condition",
                                                                   "metric",
                                                                   "record",
                                                                   "radio",
                                                                   "vary",
                                                                   "wind",
                                                                   "moving",
                                                                   "payload"};

inline constexpr std::array<std::string_view, 16> kUavKeys = {"name",
                                                              "model",
                                                              "position_m",
                                                              "yaw_deg",
                                                              "yaw_spread_deg",
                                                              "command_latency_ms",
                                                              "command_latency",
                                                              "setpoint_timeout_ms",
                                                              "on_setpoint_loss",
                                                              "profile",
                                                              "sensors",
                                                              "energy",
                                                              "sut",
                                                              "target",
                                                              "pinned_core",
                                                              "flight_controller"};

inline constexpr std::array<std::string_view, 16> kConditionKeys = {
    "name",       "description",    "policy",           "clock",
    "cpu_factor", "computing_ms",   "real_time_factor", "profile",
    "target",     "simulator",      "timing",           "mode",
    "counted",    "unknown_stages", "shared",           "radio"};

inline constexpr std::array<std::string_view, 7> kComputerKeys = {
    "name", "file", "clock", "cpu_factor", "computing_ms", "cores", "by_hand"};

}  // namespace tether::scenario
