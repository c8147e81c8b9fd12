// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_structure.hpp"

#include <algorithm>

namespace kinfer::identify {
namespace {

constexpr int kinds = 4;

bool is_signal(AngleKind kind) {
  return kind == AngleKind::signal || kind == AngleKind::offset_signal;
}

int signal_count(const LinkStructure& structure) {
  int count = 0;
  for (const LeafStructure& leaf : structure.leaves)
    count += static_cast<int>(is_signal(leaf.theta)) + static_cast<int>(is_signal(leaf.alpha));
  return count;
}

AngleKind draw_kind(Rng& rng) {
  return static_cast<AngleKind>(rng.index(kinds));
}

AngleKind& angle_at(LinkStructure& structure, std::size_t place) {
  LeafStructure& leaf = structure.leaves[place / 2];
  return place % 2 == 0 ? leaf.theta : leaf.alpha;
}

/// Makes the signal occur exactly once: of several, a random one is kept; if there is none, a random angle gets it.
LinkStructure repair(LinkStructure structure, Rng& rng) {
  if (structure.leaves.size() > max_structure_leaves) structure.leaves.resize(max_structure_leaves);
  const std::size_t angles = 2 * structure.leaves.size();
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < angles; ++i)
    if (is_signal(angle_at(structure, i))) places.push_back(i);
  if (places.empty()) {
    AngleKind& angle = angle_at(structure, rng.index(angles));
    angle = has_constant(angle) ? AngleKind::offset_signal : AngleKind::signal;
    return structure;
  }
  const std::size_t kept = places[rng.index(places.size())];
  for (const std::size_t place : places)
    if (place != kept)
      angle_at(structure, place) = has_constant(angle_at(structure, place)) ? AngleKind::constant : AngleKind::zero;
  return structure;
}

}  // namespace

std::uint32_t signature(const LinkStructure& structure) {
  std::uint32_t number = 1;  // distinguishes no leaves from leaves of zeros
  for (const LeafStructure& leaf : structure.leaves)
    number = number * 16 + static_cast<std::uint32_t>(leaf.theta) * 4 + static_cast<std::uint32_t>(leaf.alpha);
  return number;
}

int constant_count(const LinkStructure& structure) {
  int count = 0;
  for (const LeafStructure& leaf : structure.leaves)
    count += static_cast<int>(has_constant(leaf.theta)) + static_cast<int>(has_constant(leaf.alpha));
  return count;
}

int parameter_count(const LinkStructure& structure) {
  return constant_count(structure) + 2 * static_cast<int>(structure.leaves.size());
}

bool uses_signal_once(const LinkStructure& structure) {
  return signal_count(structure) == 1;
}

std::vector<LinkStructure> enumerate_structures(std::size_t leaves) {
  std::vector<LinkStructure> layer{{}}, all;
  for (std::size_t depth = 0; depth < leaves; ++depth) {
    std::vector<LinkStructure> next;
    for (const LinkStructure& structure : layer)
      for (int code = 0; code < kinds * kinds; ++code) {
        LinkStructure longer = structure;
        longer.leaves.push_back({static_cast<AngleKind>(code / kinds), static_cast<AngleKind>(code % kinds)});
        if (signal_count(longer) <= 1) next.push_back(std::move(longer));
      }
    layer = std::move(next);
    std::ranges::copy_if(layer, std::back_inserter(all), uses_signal_once);
  }
  return all;
}

LinkStructure revolute_structure() {
  using enum AngleKind;
  return {{{constant, constant}, {offset_signal, constant}, {constant, zero}}};
}

std::vector<LinkStructure> revolute_structures() {
  using enum AngleKind;
  return {revolute_structure(),
          {{{zero, constant}, {constant, offset_signal}, {constant, constant}}},
          {{{constant, constant}, {signal, constant}, {constant, constant}}},
          {{{constant, constant}, {constant, signal}, {constant, constant}}}};
}

std::string text(const LinkStructure& structure) {
  constexpr const char* suffix[kinds] = {"0", "c", "q", "q+c"};
  std::string words;
  for (const LeafStructure& leaf : structure.leaves)
    words += std::string(words.empty() ? "" : " | ") + "theta " + suffix[static_cast<int>(leaf.theta)] + " alpha " +
             suffix[static_cast<int>(leaf.alpha)];
  return words;
}

LinkStructure StructureOperators::random(Rng rng) const {
  LinkStructure structure;
  structure.leaves.resize(1 + rng.index(max_structure_leaves));
  for (LeafStructure& leaf : structure.leaves) leaf = {draw_kind(rng), draw_kind(rng)};
  return repair(structure, rng);
}

LinkStructure StructureOperators::mutate(const LinkStructure& genome, std::size_t part, Rng rng) const {
  LinkStructure structure = genome;
  const auto place = structure.leaves.begin() + static_cast<std::ptrdiff_t>(part);
  switch (rng.index(4)) {
    case 0:  // insert a leaf
      structure.leaves.insert(place, {draw_kind(rng), draw_kind(rng)});
      break;
    case 1:  // remove a leaf
      if (structure.leaves.size() > 1) structure.leaves.erase(place);
      break;
    case 2:
      place->theta = draw_kind(rng);
      break;
    default:
      place->alpha = draw_kind(rng);
  }
  return repair(structure, rng);
}

LinkStructure StructureOperators::transfer(const LinkStructure& from, std::size_t part, const LinkStructure& to,
                                           std::size_t place, Rng rng) const {
  LinkStructure structure = to;
  structure.leaves[place] = from.leaves[part];
  return repair(structure, rng);
}

std::vector<LinkStructure> neighbour_structures(const LinkStructure& structure) {
  std::vector<LinkStructure> found;
  const auto add = [&](LinkStructure other) {
    if (uses_signal_once(other)) found.push_back(std::move(other));
  };
  const std::size_t angles = 2 * structure.leaves.size();
  for (std::size_t i = 0; i < angles; ++i)
    for (int kind = 0; kind < kinds; ++kind) {
      LinkStructure other = structure;
      angle_at(other, i) = static_cast<AngleKind>(kind);
      if (other != structure) add(other);
      for (std::size_t j = 0; j < angles && is_signal(static_cast<AngleKind>(kind)); ++j)  // move the signal
        if (j != i && is_signal(angle_at(other, j))) {
          LinkStructure moved = other;
          angle_at(moved, j) = has_constant(angle_at(other, j)) ? AngleKind::constant : AngleKind::zero;
          add(moved);
        }
    }
  for (std::size_t i = 0; i < structure.leaves.size(); ++i) {
    LinkStructure shorter = structure;
    shorter.leaves.erase(shorter.leaves.begin() + static_cast<std::ptrdiff_t>(i));
    if (!shorter.leaves.empty()) add(shorter);
  }
  for (std::size_t i = 0; structure.leaves.size() < max_structure_leaves && i <= structure.leaves.size(); ++i)
    for (const LeafStructure leaf : {LeafStructure{}, LeafStructure{AngleKind::constant, AngleKind::zero},
                                     LeafStructure{AngleKind::zero, AngleKind::constant}}) {
      LinkStructure longer = structure;
      longer.leaves.insert(longer.leaves.begin() + static_cast<std::ptrdiff_t>(i), leaf);
      add(longer);
    }
  return found;
}

}  // namespace kinfer::identify
