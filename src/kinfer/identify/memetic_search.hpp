// The chain of one link by memetic bacterial programming: bacteria carry structures, numbers are fitted to each, and
// the shortest description wins; or by trying every structure there is, as a certificate.
#pragma once

#include "kinfer/base/observer.hpp"
#include "kinfer/identify/memetic_fit.hpp"
#include "kinfer/search/bacterial_options.hpp"

namespace kinfer {

struct MemeticOptions {
  BacterialOptions bacteria{.individuals = 10, .generations = 30, .clones = 3, .cycles = 1, .transfers = 3};
  MemeticFitOptions fit{};
  int patience = 4;  ///< generations without a better structure, after which the neighbours of the best are tried
  int rows = 384;    ///< samples that the cost sums over, evenly spread
};

struct MemeticOutcome {
  LinkStructure structure;
  std::vector<DhLeaf> leaves;
  double cost = 0.0;  ///< J times n^(k/2n): k numbers told by n independent ones (Rissanen's description length)
  double j = 0.0;
  std::int64_t evaluations = 0;       ///< passes over the rows, derivatives included; each structure is fitted once
  std::int64_t evaluations_to_1 = 0;  ///< after which the cost was within 1 % of the final one
  std::size_t structures = 0;         ///< that were fitted
  int generations = 0;
  std::vector<double> best_history, median_history;
};

/// `signals`: the joint's one. `rows` are evenly thinned to options.rows.
MemeticOutcome search_memetic(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                              std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                              const MemeticOptions& options, const Rng& rng, const Observer& observer = {});

/// Every structure of up to three leaves that uses the signal once.
MemeticOutcome search_all(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                          std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                          const MemeticOptions& options);

}  // namespace kinfer
