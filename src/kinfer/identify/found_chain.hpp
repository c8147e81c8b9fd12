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

/// Axes that a joint turns about, or slides along, one after another; unit, in the parent at home. A rigid one has one
/// without a reading.
std::vector<Vec3> joint_axes(FoundJointType type, const HingeGeometry& geometry);

/// DH rows of a joint: rows_through its axes.
std::vector<DhNumbers> joint_rows(FoundJointType type, const HingeGeometry& geometry);

/// The joint's rows with standard deviations. The readings are named "parent-child"; of several "parent-child 1", ...
std::vector<FoundDhRow> canonical_rows(const FoundJoint& joint, const FoundHinge& hinge);

/// One for each pair of joints that follow each other.
std::vector<FoundLink> found_links(const std::vector<FoundJoint>& joints);

/// From the root's sensor: for each joint a fixed row to its first axis, a moving row for each axis, and a fixed row to
/// the child's sensor, named after it. `dh`: canonical_rows of all joints in their order. `root_in_ground`: the root
/// sensor's orientation at the start.
Chain found_chain(const std::string& root, const std::vector<FoundJoint>& joints, const std::vector<FoundDhRow>& dh,
                  const Mat3& root_in_ground);

/// The tool of the chain is the place called "tip" or "tool", or the only one there is; the others are left out.
void carry_tool(Chain& chain, const std::vector<FoundPlace>& places);

}  // namespace kinfer
