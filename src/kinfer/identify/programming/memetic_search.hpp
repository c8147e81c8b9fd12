// SPDX-License-Identifier: Apache-2.0
// Search for one link by memetic bacterial programming: bacteria carry structures, the parameters of each are fitted,
// and the minimum description length wins; or exhaustive search over all structures, as a certificate.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/identify/programming/structure_fit.hpp"
#include "kinfer/search/evolution/evolution_options.hpp"

namespace kinfer::identify {

/// Memetic bacterial programming: structures evolve, parameters are fitted.
struct MemeticProgramming {
  BacterialOptions bacteria{.individuals = 10, .generations = 30, .clones = 3, .cycles = 1, .transfers = 3};
  int rows = default_link_rows;  ///< samples in the cost, evenly spaced
};

/// Every structure of up to three leaves.
struct Enumeration {
  int rows = default_link_rows;  ///< samples in the cost, evenly spaced
};

struct StructureSearchOutcome {
  LinkStructure structure;
  std::vector<DhLeaf> leaves;
  double cost = 0.0;  ///< J · n^(k/2n): k parameters, n independent samples (Rissanen's description length)
  double j = 0.0;
  std::int64_t evaluations = 0;  ///< passes over the rows, derivatives included; each structure is fitted once
  std::int64_t evaluations_to_1_percent = 0;  ///< evaluations until the cost was within 1 % of the final one
  std::size_t structures = 0;                 ///< number of fitted structures
  int generations = 0;
  std::vector<double> best_history, median_history;
};

/// `signals`: exactly one. `rows` are evenly thinned to options.rows.
StructureSearchOutcome search_memetic(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                      std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                                      const MemeticProgramming& options, const Rng& rng, const Observer& observer = {});

/// Every structure of up to three leaves that uses the signal once; the observer is notified after each block of them,
/// and may stop the search with the best one so far.
StructureSearchOutcome search_exhaustive(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                         std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                                         const Enumeration& options, int threads = 0, const Observer& observer = {});

}  // namespace kinfer::identify
