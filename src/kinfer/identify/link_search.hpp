// One link of the machine by bacterial programming: a tree of DH leaves behind the frozen chain (paper 1, section IV).
#pragma once

#include "kinfer/identify/link_cost.hpp"
#include "kinfer/search/bacterial.hpp"

namespace kinfer {

struct LinkSearchOptions {
  BacterialOptions bacteria{};
  DepthLimits depth{};
  DhLeafOptions leaf{};  ///< its number of signals is set by the link
  LinkCostOptions cost{};
  int rows = 384;  ///< samples that eq. (20) sums over, evenly spread; more average more noise away
};

using DhEvolution = EvolutionOutcome<DhTree>;

/// The rows of a link that tell something: all sensors sound, and the child in motion. With Euler angles not within 6°
/// of gimbal lock either, where they say nothing.
std::vector<std::size_t> telling_rows(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                      Terminals terminals);

/// The chain from the parent's sensor to the child's. `rows` are evenly thinned to options.rows.
DhEvolution search_link(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                        std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                        const LinkSearchOptions& options, const Rng& rng, const Observer& observer = {});

}  // namespace kinfer
