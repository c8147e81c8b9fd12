// SPDX-License-Identifier: Apache-2.0
// Identification of an unknown machine from an INS recording: segment tree -> joint types -> chain, link by link, by
// paper 1's bacterial programming or its memetic successor -> refinement by the continuous-time fit.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/programming/bacterial_search.hpp"
#include "kinfer/identify/programming/memetic_search.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/given_tree.hpp"
#include "kinfer/identify/structure/moving_phases.hpp"

namespace kinfer::identify {

enum class GeometrySource {
  refined,  ///< by the continuous-time fit of the whole recording
  searched  ///< as found by the search, link by link
};

/// Search method for the chain of a link.
enum class Engine {
  bmp,         ///< memetic bacterial programming: structures evolve, parameters are fitted
  bp,          ///< paper 1's bacterial programming; Euler terminals always use it
  enumeration  ///< every structure of up to three leaves
};

struct IdentifyOptions {
  SegmentMotionOptions motion{};
  JointVariableKind terminals = JointVariableKind::hinge;
  Engine engine = Engine::bmp;
  MemeticOptions memetic{};            ///< of bmp and enumeration
  BacterialLinkOptions search{};       ///< of bp; its settings that depend on `terminals` are overwritten
  std::optional<std::string> root{};   ///< sensor; see segment_tree
  std::vector<std::string> sensors{};  ///< that belong to the machine; empty: all of the log
  std::vector<GivenLink> tree{};       ///< links given by the user; empty: estimated from the log
  int links = 0;                       ///< number of links from the root outwards; 0: all (paper 1: the first three)
  GeometrySource geometry = GeometrySource::refined;
  RefinementOptions refine{};
  int threads = 0;
};

/// An error if no chain can be identified: fewer than two sensors, or a sensor or joint that never moves.
Result<Identification> identify_machine(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                                        const Observer& observer = {});

}  // namespace kinfer::identify
