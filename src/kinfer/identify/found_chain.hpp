// The lasting products of an identification, made from the found hinges: canonical DH rows, link lengths, a chain.
#pragma once

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/hinge_precision.hpp"

namespace kinfer {

/// A joint as found, with what only its maker needs.
struct FoundHinge {
  HingeGeometry geometry;
  HingePrecision precision;
};

FoundJoint found_joint(const std::string& parent, const std::string& child, const FoundHinge& hinge);

/// A row for each leaf, its variables named by the signals.
std::vector<FoundDhRow> found_rows(const std::string& segment, std::span<const DhLeaf> leaves,
                                   std::span<const JointSignal> signals);

/// The three canonical rows of a hinge, with standard deviations; the second one's theta has the joint's angle added,
/// which is named "parent-child".
std::vector<FoundDhRow> canonical_rows(const FoundJoint& joint, const FoundHinge& hinge);

/// One for each pair of joints that follow each other.
std::vector<FoundLink> found_links(const std::vector<FoundJoint>& joints);

/// From the root's sensor: for each joint a fixed row to its axis, the revolute row, and a fixed row to the child's
/// sensor, named after it. `root_in_ground`: the root sensor's orientation at the start.
Chain found_chain(const std::string& root, const std::vector<FoundJoint>& joints, const std::vector<FoundDhRow>& dh,
                  const Mat3& root_in_ground);

/// The tool of the chain is the place called "tip" or "tool", or the only one there is; the others are left out.
void carry_tool(Chain& chain, const std::vector<FoundPlace>& places);

}  // namespace kinfer
