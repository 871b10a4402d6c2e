#include "commands/trial_service.h"

#include "back_ends.h"
#include "terminal/errors_printed.h"
#include "terminal/print.h"

#include <exception>
#include <optional>
#include <string>

#include <tether/campaign/result.h>
#include <tether/os/interrupt.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_request.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::app {

runner::TrialService trial_service(sim::WorldStore& worlds) {
  return {.prepare =
              [&worlds](const runner::TrialRequest& request) {
                try {
                  const runner::TrialSpec spec = runner::make_trial(request);
                  worlds.load(scenario::world_request(spec.scenario, spec.seed), nullptr);
                } catch (const std::exception&) {  // the trial meets and prints the same one
                }
              },
          .run =
              [&worlds](const runner::TrialRequest& request) {
                return with_errors_printed([&] {
                  runner::TrialSpec spec = runner::make_trial(request);
                  spec.worlds = &worlds;
                  spec.was_tried = true;
                  const os::Interrupt interrupt;
                  runner::TrialObserver observer;
                  observer.on_refused = [](const std::string& text) {
                    complain("warning: " + text);
                  };
                  const campaign::TrialResult result =
                      runner::run_trial(spec, find_back_end, observer, interrupt.token());
                  if (result.outcome == campaign::Outcome::kFailed)
                    complain("tether: " + result.reason);
                  return campaign::exit_code(result);
                });
              }};
}

}  // namespace tether::app
