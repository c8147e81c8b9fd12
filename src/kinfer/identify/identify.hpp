// Recordings of INS on an unknown machine -> order of its segments -> joint types -> chain, link
// after link, by paper 1's bacterial programming or its memetic successor.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/given_tree.hpp"
#include "kinfer/identify/link_search.hpp"
#include "kinfer/identify/memetic_search.hpp"
#include "kinfer/identify/moving_phases.hpp"
#include "kinfer/identify/refine.hpp"

namespace kinfer {

enum class Geometry {
  refined,  ///< the continuous-time fit of the whole recording has the last word
  searched  ///< as the search found it, link after link
};

/// How the chain of a link is searched.
enum class Engine {
  bmp,         ///< memetic bacterial programming: structures evolve, numbers are fitted
  bp,          ///< paper 1's bacterial programming; always with Euler terminals
  enumeration  ///< every structure of up to three leaves
};

struct IdentifyOptions {
  SegmentMotionOptions motion{};
  Terminals terminals = Terminals::hinge;
  Engine engine = Engine::bmp;
  MemeticOptions memetic{};            ///< of bmp and enumeration
  LinkSearchOptions search{};          ///< of bp; what of it depends on the terminals follows them
  std::optional<std::string> root{};   ///< sensor; see segment_tree
  std::vector<std::string> sensors{};  ///< that belong to the machine; empty: all of the log
  std::vector<GivenLink> tree{};       ///< which sensors' segments share joints; empty: as the log tells
  int links = 0;                       ///< of the tree, from the root outwards; 0: all (the paper did the first three)
  Geometry geometry = Geometry::refined;
  RefineOptions refine{};
  int threads = 0;
};

/// An error where the recording cannot show a chain: fewer than two sensors, a sensor or a joint that never moves.
Result<Identification> identify(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                                const Observer& observer = {});

}  // namespace kinfer
