// SPDX-License-Identifier: Apache-2.0
// Each study in a folder of its own: it takes what a program takes, and returns an exit code.
#pragma once

namespace kinfer::study {

int run_azimuth(int argc, char** argv);
int run_clipping(int argc, char** argv);
int run_coverage(int argc, char** argv);
int run_diodem(int argc, char** argv);
int run_fleet(int argc, char** argv);
int run_identify(int argc, char** argv);
int run_lengths(int argc, char** argv);
int run_log_faults(int argc, char** argv);
int run_loops(int argc, char** argv);
int run_noise(int argc, char** argv);
int run_orientation(int argc, char** argv);
int run_paper1(int argc, char** argv);
int run_paper2(int argc, char** argv);
int run_planning(int argc, char** argv);
int run_reach(int argc, char** argv);
int run_regret(int argc, char** argv);
int run_robots(int argc, char** argv);
int run_search_start(int argc, char** argv);
int run_structure(int argc, char** argv);
int run_thresholds(int argc, char** argv);
int run_track(int argc, char** argv);
int run_update(int argc, char** argv);
int run_verdict(int argc, char** argv);

}  // namespace kinfer::study
