#include "commands/trial_service.h"

#include "commands/commands.h"
#include "options/command_line.h"
#include "terminal/errors_printed.h"

#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <tether/os/interrupt.h>

namespace tether::app {

runner::TrialService trial_service(sim::WorldStore& worlds) {
  return {.prepare =
              [&worlds](const std::vector<std::string>& arguments) {
                try {
                  read_world_ahead(parse_run(arguments), worlds);
                } catch (const std::exception&) {  // the trial meets and prints the same one
                }
              },
          .run =
              [&worlds](const std::vector<std::string>& arguments) {
                std::optional<os::Interrupt> interrupt;
                return with_errors_printed([&] {
                  RunOptions options = parse_run(arguments);
                  options.worlds = &worlds;
                  interrupt.emplace();
                  return run_one(options, interrupt->token());
                });
              }};
}

}  // namespace tether::app
