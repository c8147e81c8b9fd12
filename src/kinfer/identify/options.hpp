// SPDX-License-Identifier: Apache-2.0
// Options of an identification: what may be set, whether it is consistent, and its record for the provenance.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kinfer/identify/programming/link_engine.hpp"
#include "kinfer/identify/refinement/refine.hpp"
#include "kinfer/identify/structure/given_tree.hpp"

namespace kinfer::identify {

enum class GeometrySource {
  refined,  ///< by the continuous-time fit of the whole recording
  searched  ///< as found by the search, link by link
};

struct IdentifyOptions {
  SegmentMotionOptions motion{};
  LinkEngine engine = MemeticProgramming{};
  std::optional<std::string> root{};   ///< sensor; see segment_tree
  std::vector<std::string> sensors{};  ///< that belong to the machine; empty: all of the log
  std::vector<GivenLink> tree{};       ///< links given by the user; empty: estimated from the log
  int links = 0;                       ///< number of links from the root outwards; 0: all (paper 1: the first three)
  GeometrySource geometry = GeometrySource::refined;
  RefinementOptions refine{};  ///< of refined geometry; its clocks are set by the synchronisation
  int threads = 0;             ///< 0: all cores; the result does not depend on it
};

/// An error, in the words of the command line, for values out of range and for options without effect.
Result<void> check(const IdentifyOptions& options);

/// Name and value of every option that has an effect, in the words of the command line; without inputs, threads, seed.
std::vector<std::pair<std::string, std::string>> describe(const IdentifyOptions& options);

}  // namespace kinfer::identify
