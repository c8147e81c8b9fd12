// What a chain of DH leaves is before it has numbers: which of its angles are constants and where the joint's signal
// stands. Lengths have no place in it, for they follow from the angles by linear least squares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/identify/dh_leaf.hpp"

namespace kinfer {

/// What one angle of a leaf is.
enum class AngleKind : std::uint8_t { zero, constant, signal, offset_signal };

/// Whether the angle has a number of its own.
inline bool has_constant(AngleKind kind) {
  return kind == AngleKind::constant || kind == AngleKind::offset_signal;
}

struct LeafStructure {
  AngleKind theta = AngleKind::zero, alpha = AngleKind::zero;
  bool operator==(const LeafStructure&) const = default;
};

/// Leaves front to back. A hinge needs three: to its axis, about it, and to the sensor behind it.
struct LinkStructure {
  std::vector<LeafStructure> leaves;
  bool operator==(const LinkStructure&) const = default;
};

constexpr std::size_t most_leaves = 3;  // ten numbers describe a hinge: three leaves have room for them

/// One number a structure, four bits a leaf, hashed by position.
std::uint32_t signature(const LinkStructure& structure);

/// Constant angles plus both lengths of each leaf.
int number_count(const LinkStructure& structure);
int angle_count(const LinkStructure& structure);

/// Whether the joint's signal stands in it exactly once.
bool uses_signal_once(const LinkStructure& structure);

/// All structures of up to `leaves` leaves in which the signal stands once: 8, 72, 456 for 1, 2, 3.
std::vector<LinkStructure> all_structures(std::size_t leaves);

/// The structure that any hinge has: an axis anywhere in the parent, an axis anywhere in the child.
LinkStructure hinge_structure();

/// All ways to write it: the signal about z or about x, its constant beside it or in the next leaf.
std::vector<LinkStructure> hinge_structures();

/// "theta c alpha c | theta q alpha c": for people.
std::string text(const LinkStructure& structure);

/// Breeds structures as search/bacterial.hpp wants it. A part is a leaf.
struct StructureBreed {
  using Genome = LinkStructure;
  Genome random(Rng rng) const;
  std::size_t parts(const Genome& genome) const { return genome.leaves.size(); }
  Genome mutated(const Genome& genome, std::size_t part, Rng rng) const;
  Genome transferred(const Genome& from, std::size_t part, const Genome& to, std::size_t place, Rng rng) const;
};

/// All structures that differ from it in one angle, a leaf more or a leaf less.
std::vector<LinkStructure> neighbours(const LinkStructure& structure);

}  // namespace kinfer
