// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/verb_list.hpp"

namespace kinfer::cli {

std::vector<Verb> add_verbs(CLI::App& app) {
  return {add_inspect(app), add_pair(app),       add_orient(app),     add_identify(app), add_calibrate(app),
          add_predict(app), add_verify(app),     add_compensate(app), add_reach(app),    add_path(app),
          add_track(app),   add_frames(app),     add_convert(app),    add_simulate(app), add_simulate_poses(app),
          add_report(app),  add_plan(app),       add_forecast(app),   add_sweep(app),    add_merge(app),
          add_demo(app),    add_completion(app), add_man(app)};
}

}  // namespace kinfer::cli
