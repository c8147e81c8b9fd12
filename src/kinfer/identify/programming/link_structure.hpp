// SPDX-License-Identifier: Apache-2.0
// Structure of a chain of DH leaves without parameter values: which of its angles are constants and which one contains
// the joint's signal. Lengths are not part of it: they follow from the angles by linear least squares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/identify/programming/dh_leaf.hpp"

namespace kinfer::identify {

/// What one angle of a leaf consists of.
enum class AngleKind : std::uint8_t { zero, constant, signal, offset_signal };

/// Whether the angle has a constant to be estimated.
inline bool has_constant(AngleKind kind) {
  return kind == AngleKind::constant || kind == AngleKind::offset_signal;
}

struct LeafStructure {
  AngleKind theta = AngleKind::zero, alpha = AngleKind::zero;
  bool operator==(const LeafStructure&) const = default;
};

/// Leaves from parent to child. A general revolute joint needs three: to its axis, about it, and to the child's sensor.
struct LinkStructure {
  std::vector<LeafStructure> leaves;
  bool operator==(const LinkStructure&) const = default;
};

constexpr std::size_t max_structure_leaves = 3;  // a revolute joint has ten parameters: three leaves suffice

/// Unique key of a structure: four bits a leaf, in order.
std::uint32_t signature(const LinkStructure& structure);

/// Constant angles plus both lengths of each leaf.
int parameter_count(const LinkStructure& structure);
int constant_count(const LinkStructure& structure);

/// Whether the joint's signal occurs exactly once.
bool uses_signal_once(const LinkStructure& structure);

/// All structures of up to `leaves` leaves in which the signal occurs once: 8, 72, 456 for 1, 2, 3.
std::vector<LinkStructure> enumerate_structures(std::size_t leaves);

/// The general revolute joint: an axis anywhere in the parent and anywhere in the child.
LinkStructure revolute_structure();

/// All equivalent forms of it: the signal about z or about x, its offset in the same angle or in another leaf.
std::vector<LinkStructure> revolute_structures();

/// "theta c alpha c | theta q alpha c": for display.
std::string text(const LinkStructure& structure);

/// Genetic operators on structures for search/bacterial.hpp. A part is a leaf.
struct StructureOperators {
  using Genome = LinkStructure;
  Genome random(Rng rng) const;
  std::size_t part_count(const Genome& genome) const { return genome.leaves.size(); }
  Genome mutate(const Genome& genome, std::size_t part, Rng rng) const;
  Genome transfer(const Genome& from, std::size_t part, const Genome& to, std::size_t place, Rng rng) const;
};

/// All structures that differ from it in one angle, in the signal's angle, or by one leaf more or less.
std::vector<LinkStructure> neighbour_structures(const LinkStructure& structure);

}  // namespace kinfer::identify
