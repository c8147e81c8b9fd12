// SPDX-License-Identifier: Apache-2.0
// Which identified parameter, if any, sets a number of the chain, and a walk along the chain that asks for each.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinfer/kinematics/batch/kernel_interface.hpp"
#include "kinfer/kinematics/elementary_motions.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::batch {

/// 0: the base, 1: the tool, 2 and more: the joints. None: not a number of the chain itself.
std::optional<int> place_in_chain(const ParameterAddress& at);

/// Finds the parameter, if any, that sets a number of the chain.
class ParameterLookup {
 public:
  explicit ParameterLookup(const ParameterSet& set);

  /// Of a field of the base, the tool or a joint (place_in_chain).
  Value value(int place, Field field, double constant, elementary::Motion motion) const;
  bool frees_base() const { return frees_base_; }
  const std::vector<int>& angles() const { return angles_; }

 private:
  struct Key {
    int place;
    Field field;
    bool operator==(const Key&) const = default;
  };
  static std::uint32_t bit(Field field) { return std::uint32_t{1} << static_cast<int>(field); }

  /// Callers walk along the chain, and most sets are in that order: the search starts after the last match.
  int index_of(const Key& key) const;

  std::vector<Key> keys_;
  std::vector<int> angles_, angle_;  // of a parameter: its index among the angles
  std::uint32_t fields_ = 0;         // one bit each
  bool frees_base_ = false;
  mutable std::ptrdiff_t next_ = 0;
};

/// Calls visit.move for each elementary motion and visit.rotate for each constant rotation.
template <class Visitor>
struct Walker {
  const ParameterLookup& lookup;
  Visitor& visit;
  int place = 0;  // place_in_chain
  int joint = -1;

  void operator()(const Mat3& rotation) {
    if (rotation != Mat3::Identity()) visit.rotate(rotation);
  }
  void operator()(const elementary::Factor& factor) {
    visit.move(factor,
               factor.field ? lookup.value(place, *factor.field, factor.value, factor.motion)
                            : Value{.constant = factor.value},
               joint);
  }
};

template <class Visitor>
void walk(const Frame& frame, SetupFrame which, const ParameterLookup& lookup, Visitor& visit) {
  elementary::for_each_factor(frame, Walker<Visitor>{lookup, visit, which == SetupFrame::base ? 0 : 1, -1});
}
template <class Visitor>
void walk(const Joint& joint, int index, const ParameterLookup& lookup, Visitor& visit) {
  elementary::for_each_factor(joint, Walker<Visitor>{lookup, visit, 2 + index, index});
}

template <class Visitor>
void walk_joints_and_tool(const Chain& chain, const ParameterLookup& lookup, Visitor& visit) {
  for (const int j : path_to(chain, chain.tip_joint())) walk(chain.joints[j], j, lookup, visit);
  walk(chain.tool, SetupFrame::tool, lookup, visit);
}

}  // namespace kinfer::batch
