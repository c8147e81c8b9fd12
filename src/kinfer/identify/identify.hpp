// Paper 1 end to end: recordings of INS on an unknown machine -> order of its segments -> chain, link after link.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/link_search.hpp"
#include "kinfer/identify/moving_phases.hpp"
#include "kinfer/identify/refine.hpp"

namespace kinfer {

enum class Geometry {
  refined,  ///< the continuous-time fit of the whole recording has the last word
  searched  ///< as the search found it, link after link
};

struct IdentifyOptions {
  SegmentMotionOptions motion{};
  Terminals terminals = Terminals::hinge;
  LinkSearchOptions search{};         ///< what of it depends on the terminals follows them
  std::optional<std::string> root{};  ///< sensor; see segment_tree
  int links = 0;                      ///< of the tree, from the root outwards; 0: all (the paper did the first three)
  Geometry geometry = Geometry::refined;
  RefineOptions refine{};
  int threads = 0;
};

/// An error where the recording cannot show a chain: fewer than two sensors, a sensor or a joint that never moves.
Result<Identification> identify(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                                const Observer& observer = {});

}  // namespace kinfer
