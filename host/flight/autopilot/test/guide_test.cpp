#include "modes.h"
#include "parameters.h"
#include "telemetry.h"

#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

// The tables and lists of the guide are those of the sources.
namespace tether::autopilot {
namespace {

std::string guide() {
  std::ifstream file(TETHER_SOURCE_DIR "/docs/guide/flight-controllers.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string parameters_table() {
  std::string table = "| parameter | at first | limits | meaning |\n|---|---:|---|---|\n";
  for (const ParameterInfo& info : parameter_infos())
    table += fmt::format("| `{}` | {:g} | {:g}…{:g} | {} |\n", info.name, info.initial, info.min,
                         info.max, info.meaning);
  return table;
}

std::string streams_list() {
  std::string list;
  for (const StreamRate& stream : stream_rates())
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", stream.name,
                        stream.rate_hz == 0.0 ? "on request" : fmt::format("{:g}", stream.rate_hz));
  return list + ".";
}

TEST(Guide, HasTheParameters) {
  EXPECT_NE(guide().find(parameters_table()), std::string::npos)
      << "docs/guide/flight-controllers.md needs this table:\n"
      << parameters_table();
}

TEST(Guide, HasTheMessages) {
  EXPECT_NE(guide().find(streams_list()), std::string::npos)
      << "docs/guide/flight-controllers.md needs this list:\n"
      << streams_list();
}

TEST(Guide, HasTheModes) {
  const std::string page = guide();
  for (const ModeInfo& mode : kModes) {
    const std::string numbers =
        mode.sub == 0 ? fmt::format("{}", mode.main) : fmt::format("{}, {}", mode.main, mode.sub);
    EXPECT_NE(page.find(fmt::format("| {} | {} |", mode.name, numbers)), std::string::npos)
        << mode.name;
  }
}

}  // namespace
}  // namespace tether::autopilot
