// SPDX-License-Identifier: Apache-2.0
// Prints one table of ratios: each figure of kinfer over its peer's, both measured in this run.
#include "ratios.hpp"

int main(int argc, char** argv) {
  return kinfer::bench::run_and_print_ratios(argc, argv);
}
